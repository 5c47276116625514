/// The path loop: the radiance along a camera ray. One loop for all effects; those that a kernel leaves out leave
/// neither code nor state.
#pragma once

#include "tandem/kernel/block_barrier.h"
#include "tandem/kernel/direct_light.h"
#include "tandem/kernel/path_limits.h"
#include "tandem/kernel/scatter.h"
#include "tandem/kernel/shape.h"

namespace tandem {

/// Counts along paths, of many together.
template <class Real>
struct PathTally {
    UInt<Real> lost_media = UInt<Real>(0U);  ///< interfaces where the stack of media was inconsistent
    UInt<Real> rays = UInt<Real>(0U);        ///< that were traced, with shadow rays; if counts_rays()
};

/// What a path hits.
template <class Real>
struct Vertex {
    SurfacePoint<Real> point;
    Surface<Real> surface;
};

/// Finds the vertex at `hit`, which `ray` from `source` found, in the lanes of `found`.
template <class Effects, std::uint32_t kinds, class Real, class From>
TANDEM_HD void find_vertex(const SceneView& scene, const Ray<Real>& ray, const From& source, const Closest<Real>& hit,
                           const Mask<Real>& found, Vertex<Real>& vertex) {
    vertex.surface = surface_at<Effects, kinds>(scene, ray, source, hit, found, vertex.point);
}
/// The same as a step of a path that is long.
template <class Effects, std::uint32_t kinds, class Real, class From>
TANDEM_HD_STAGE void step_to_vertex(const SceneView& scene, const Ray<Real>& ray, const From& source,
                                    const Closest<Real>& hit, const Mask<Real>& found, Vertex<Real>& vertex) {
    find_vertex<Effects, kinds>(scene, ray, source, hit, found, vertex);
}

/// The weight of the emission that a path finds on a surface, in the lanes of `glows`: the rest was sampled from the
/// lights at the vertex before. `point`: where the path has hit the surface.
///
/// Method: both densities of the power heuristic belong to the point that the direction was sampled from,
/// `sampled_from`. The ray starts a little above a face, and from there a near light is larger. So the light is scaled
/// by the ratio of its projected solid angles, as seen from `sampled_from` and from the ray's origin. For microfacets,
/// whose lobe is no longer known, the density is that with which the direction was sampled, the choice of the lobe
/// included.
template <class Effects, class Real>
TANDEM_HD Real seen_share(const SceneView& scene, const PathState<Effects, Real, true>& path, const Closest<Real>& hit,
                          const SurfacePoint<Real>& point, const Mask<Real>& glows) {
    using D = Double<Real>;
    const Real whole(1.0F);
    if (!Effects::has_any(Effect::indirect | Effect::microfacets) || !Effects::has(Effect::area_lights)) return whole;
    const Mask<Real> glossy = Mask<Real>(Effects::has(Effect::microfacets)) && path.pdf < D(0.0);
    const Mask<Real> shared = glows && (path.pdf > D(0.0) || glossy);
    if (scene.area_light_count == 0 || !any(shared)) return whole;
    const D zero(0.0);
    const D one(1.0);
    const Vec3<D> sampled_from = widen(path.sampled_from);
    const Vec3<D> raised = widen(path.ray.origin) - sampled_from;  // along the normal, if at all
    const Vec3<D> along = widen(path.ray.direction);
    const Vec3<D> way = {raised.x + hit.t * along.x, raised.y + hit.t * along.y, raised.z + hit.t * along.z};
    const D inverse = inverse_square_root(dot(way, way));
    const Vec3<D> direction = way * inverse;
    const D length2 = dot(along, along);
    const D shorter = hit.t * square_root(length2) * inverse;  // the ray's length over that of `way`
    const D cosine = path.pdf * constant<D>(pi);
    const D seen_cosine = cosine * shorter + square_root(dot(raised, raised)) * inverse;
    const D facing = dot(along, point.normal) * inverse_square_root(length2);
    const Mask<Real> faces = facing != zero;
    const D turned = select(faces, dot(direction, point.normal) / select(faces, facing, one), one);
    // where the light is seen edge-on, the ratio has no bound
    const D brighter = select(glossy, one, seen_cosine / cosine);
    const D growth = (brighter * turned) * (shorter * shorter);
    const D bounded = select(growth < D(2.0), greater(growth, zero), D(2.0));
    const D other = area_light_pdf<Real>(scene, hit.primitive, sampled_from, direction, shared);
    const D pdf = select(glossy, -path.pdf, cosine_hemisphere_pdf(seen_cosine));
    const D share = power_heuristic(pdf, other) * bounded;
    return select(shared, to_real<Real>(share), whole);
}

namespace path_detail {

/// Adds the background to paths that hit nothing, in the lanes of `missed`.
template <class Effects, class Real, bool bounces>
TANDEM_HD void see_background(const SceneView& scene, const Mask<Real>& missed, PathState<Effects, Real, bounces>& path,
                              Vec3<Real>& radiance) {
    using D = Double<Real>;
    const bool picture = has_environment_picture<Effects>(scene);
    const Vec3<Real> seen = picture ? seen_environment_picture<Effects, Real, bounces>(scene, path)
                                    : background(scene.environment, path.ray.direction);
    if constexpr (bounces) {
        path.absorb(scene, D(__builtin_huge_val()), UInt<Real>(no_medium), missed);
        Mask<Real> shows = missed;
        // only matt surfaces ask whether it illuminates
        if (Effects::has(Effect::indirect) && scene.environment.illuminates == 0) shows = shows && !(path.pdf > D(0.0));
        radiance = select(shows, radiance + path.throughput * seen, radiance);
    } else {
        radiance = select(missed, seen, radiance);
    }
}

/// The point of a ray at t.
template <class Real>
TANDEM_HD Vec3<Double<Real>> point_of(const Ray<Real>& ray, const Double<Real>& t) {
    return spawn_detail::along<Real>(widen(ray.origin), widen(ray.direction), t);
}

}  // namespace path_detail

/// The next hit of paths: for those that cannot continue, that of the camera ray.
template <class Effects, class Real, class Tracer>
TANDEM_HD Closest<Real> next_hit(const Tracer& tracer, const PathState<Effects, Real>& path, PathTally<Real>& tally) {
    count_rays<Effects, Real>(path.alive, tally.rays);
    if constexpr (can_bounce<Effects>()) {
        return nearest_hit<Effects>(tracer, path.ray, path.source, path.alive);
    } else {
        return nearest_hit<Effects>(tracer, path.ray, NoSource(), path.alive);
    }
}

/// Follows paths that end at their first vertex.
template <class Effects, class Real, class Tracer>
requires(!can_bounce<Effects>()) TANDEM_HD
    void advance(const Tracer& tracer, const SceneView& scene, const PathLimits&, const SampleId<Real>& sample,
                 const UInt<Real>& number, const Closest<Real>& hit, PathState<Effects, Real>& path,
                 Vec3<Real>& radiance, PathTally<Real>& tally) {
    const NoSource source;
    const Mask<Real> found = path.alive && hit.primitive != UInt<Real>(no_primitive);
    const Mask<Real> missed = path.alive && !found;
    path.alive = Mask<Real>(false);
    if (any(missed)) path_detail::see_background(scene, missed, path, radiance);
    if (!any(found)) return;
    Vertex<Real> vertex;
    if constexpr (can_leave_surfaces<Effects>()) {
        step_to_vertex<Effects, Tracer::kinds>(scene, path.ray, source, hit, found, vertex);
    } else {
        find_vertex<Effects, Tracer::kinds>(scene, path.ray, source, hit, found, vertex);
    }
    auto reflected = reflected_light<Effects>(tracer, scene, vertex.surface, path_detail::point_of(path.ray, hit.t),
                                              -normalize(widen(path.ray.direction)), vertex.point, sample, number,
                                              FollowedLobes<Real>(), found, tally.rays);
    if (Effects::has(Effect::emission)) reflected = reflected + vertex.surface.emission;
    radiance = select(found, reflected, radiance);
}

/// Follows paths from their vertex at `hit`, which next_hit() found, number `number` of theirs, to where they leave it;
/// what they contribute is added to `radiance`. Paths that end are no longer alive. `Effects`: what is simulated
/// (effects/effects.h); what the scene needs beyond it is left out, and what it does not need changes no bit in strict
/// and precise. `Tracer` is a LoopTracer (kernel/traversal/intersect.h) or has its functions, and `kinds`, the
/// PrimitiveKinds that it finds. On a GPU all threads of a block call this together (kernel/block_barrier.h).
template <class Effects, class Real, class Tracer>
requires(can_bounce<Effects>()) TANDEM_HD
    void advance(const Tracer& tracer, const SceneView& scene, const PathLimits& limits, const SampleId<Real>& sample,
                 const UInt<Real>& number, const Closest<Real>& hit, PathState<Effects, Real>& path,
                 Vec3<Real>& radiance, PathTally<Real>& tally) {
    using D = Double<Real>;
    const PathSource<Real> source = path.source;
    Mask<Real> found = path.alive && hit.primitive != UInt<Real>(no_primitive);
    const Mask<Real> missed = path.alive && !found;
    path.alive = found;
    if (any(missed)) path_detail::see_background(scene, missed, path, radiance);

    gather_block<Effects>();
    if (!any(found) && !keeps_together<Effects>()) return;
    Vertex<Real> vertex;
    ShadingFrame<Real> shading;
    Vec3<D> to_viewer;
    Mask<Real> holes(false);
    FollowedLobes<Real> followed;
    Real glossy(0.0F);
    if (any(found)) {
        step_to_vertex<Effects, Tracer::kinds>(scene, path.ray, source, hit, found, vertex);
        to_viewer = -normalize(widen(path.ray.direction));
        shading = make_shading_frame(vertex.surface, vertex.point, to_viewer);
        const Mask<Real> in_glass = shading.from_inside && vertex.surface.transmission > Real(0.0F);
        path.absorb(scene, hit.t, select(in_glass, vertex.surface.material, UInt<Real>(no_medium)), found);
        holes = found && !vertex.surface.opaque;
        if (Effects::has(Effect::cutouts)) found = found && !holes;
        if (Effects::has(Effect::emission)) {
            const Mask<Real> glows = found && norm1(vertex.surface.emission) > Real(0.0F);
            const Real share = seen_share<Effects>(scene, path, hit, vertex.point, glows);
            // unlit surfaces light nothing: paths that a surface has scattered do not see their emission
            const Mask<Real> dark =
                Mask<Real>(Effects::has(Effect::indirect)) && vertex.surface.unlit && path.pdf > D(0.0);
            radiance = select(found && !dark, radiance + path.throughput * (vertex.surface.emission * share), radiance);
        }
        reduce_by_transmission<Effects>(vertex.surface, shading);
        followed.diffuse = shading.is_front && path.scatterings < UInt<Real>(limits.diffuse);
        if (Effects::has(Effect::microfacets)) {
            glossy = glossy_weight<Effects>(vertex.surface, vertex.point, shading, found);
            followed.glossy = vertex.surface.has_microfacets && path.reflections < UInt<Real>(limits.reflection);
            const Real total = lobe_weights<Effects>(scene, vertex.surface, shading, glossy).total();
            followed.glossy_chance = select(glossy > Real(0.0F), glossy / total, Real(1.0F));
        }
    }

    const auto reflected =
        reflected_light<Effects>(tracer, scene, vertex.surface, path_detail::point_of(path.ray, hit.t), to_viewer,
                                 vertex.point, sample, number, followed, found, tally.rays);
    gather_block<Effects>();
    if (!any(path.alive)) return;
    radiance = select(found, radiance + path.throughput * reflected, radiance);
    if (!has_bounces<Effects>()) {
        path.alive = Mask<Real>(false);
        return;
    }
    path.alive = found;
    const Mask<Real> lost =
        scatter<Effects>(scene, limits, sample, number, vertex.surface, vertex.point, shading, glossy, path);
    tally.lost_media = tally.lost_media + select(lost, UInt<Real>(1U), UInt<Real>(0U));
    if (Effects::has(Effect::cutouts) && any(holes)) continue_through_mask(hit, holes, path);
}

}  // namespace tandem
