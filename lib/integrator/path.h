/// The path loop: what comes back along a camera ray. One loop for all effects; those that a kernel leaves out leave
/// neither code nor state.
#pragma once

#include "tandem/integrator/direct_light.h"
#include "tandem/integrator/path_limits.h"
#include "tandem/integrator/scatter.h"

namespace tandem {

/// What a path brings.
template <class Real>
struct PathResult {
    Vec3<Real> radiance;                     ///< RGB, linear
    UInt<Real> lost_media = UInt<Real>(0U);  ///< borders at which the stack of media was at a loss
};

/// What a path meets.
template <class Real>
struct Vertex {
    SurfacePoint<Real> point;
    Surface<Real> surface;
};

/// The vertex at `hit`, which `ray` from `source` found, in the lanes of `found`.
template <class Effects, std::uint32_t kinds, class Real, class From>
requires(!can_leave_surfaces<Effects>()) TANDEM_HD Vertex<Real> vertex_at(const SceneView& scene, const Ray<Real>& ray,
                                                                          const From& source, const Closest<Real>& hit,
                                                                          const Mask<Real>& found) {
    Vertex<Real> vertex;
    vertex.surface = surface_at<Effects, kinds>(scene, ray, source, hit, found, vertex.point);
    return vertex;
}
template <class Effects, std::uint32_t kinds, class Real, class From>
requires(can_leave_surfaces<Effects>()) TANDEM_HD_STEP Vertex<Real> vertex_at(const SceneView& scene,
                                                                              const Ray<Real>& ray, const From& source,
                                                                              const Closest<Real>& hit,
                                                                              const Mask<Real>& found) {
    Vertex<Real> vertex;
    vertex.surface = surface_at<Effects, kinds>(scene, ray, source, hit, found, vertex.point);
    return vertex;
}

/// The share of a surface's own light that a path may count which has found it: the rest is what was drawn from the
/// lights at the vertex before.
template <class Effects, class Real>
TANDEM_HD Real seen_share(const SceneView& scene, const PathState<Effects, Real, true>& path, const Closest<Real>& hit,
                          const Mask<Real>& found) {
    using D = Double<Real>;
    const Real whole(1.0F);
    if (!Effects::has(Effect::indirect) || !Effects::has(Effect::area_lights)) return whole;
    const Mask<Real> shared = found && path.pdf > D(0.0);
    if (scene.area_light_count == 0 || !any(shared)) return whole;
    const Vec3<D> direction = normalize(widen(path.ray.direction));
    const D other = area_light_pdf<Real>(scene, hit.primitive, widen(path.ray.origin), direction, shared);
    return select(shared, to_real<Real>(power_heuristic(path.pdf, other)), whole);
}

/// Follows paths to their next vertex, number `vertex` of theirs, and on to where they leave it; what they bring is
/// added to `result`. Paths that end are no longer alive. `Effects`: what is simulated (effects/effects.h); what the
/// scene calls for beyond it is left out, and what it does not call for changes no bit in strict and precise. `Tracer`
/// is a LoopTracer (geometry/intersect.h) or has its functions, and `kinds`, the PrimitiveKinds that it finds.
template <class Effects, class Real, class Tracer>
TANDEM_HD void advance(const Tracer& tracer, const SceneView& scene, const PathLimits& limits,
                       const SampleId<Real>& sample, const UInt<Real>& vertex, PathState<Effects, Real>& path,
                       PathResult<Real>& result) {
    using D = Double<Real>;
    constexpr bool bounces = can_bounce<Effects>();
    using From = std::conditional_t<bounces, Source<Real>, NoSource>;
    const Real zero(0.0F);
    From source{};
    if constexpr (bounces) source = path.source;
    const Closest<Real> hit = nearest_hit<Effects>(tracer, path.ray, source, path.alive);
    Mask<Real> found = path.alive && hit.primitive != UInt<Real>(no_primitive);
    const Mask<Real> missed = path.alive && !found;
    path.alive = found;
    if (any(missed)) {
        const Vec3<Real> seen = background(scene.environment, path.ray.direction);
        if constexpr (bounces) {
            path.absorb(scene, hit.t, UInt<Real>(no_medium), missed);
            Mask<Real> shows = missed;
            if (Effects::has(Effect::indirect) && scene.environment.illuminates == 0) {
                shows = shows && path.pdf == D(0.0);
            }
            result.radiance = select(shows, result.radiance + path.throughput * seen, result.radiance);
        } else {
            result.radiance = select(missed, seen, result.radiance);
        }
    }
    if (!any(found)) return;

    const auto [point, surface] = vertex_at<Effects, Tracer::kinds>(scene, path.ray, source, hit, found);
    const Vec3<D> direction = widen(path.ray.direction);
    const Vec3<D> origin = widen(path.ray.origin);
    const Vec3<D> position = {origin.x + hit.t * direction.x, origin.y + hit.t * direction.y,
                              origin.z + hit.t * direction.z};
    const Vec3<D> to_viewer = -normalize(direction);
    if constexpr (!bounces) {
        auto reflected = reflected_light<Effects>(tracer, scene, surface, position, to_viewer, point, sample, vertex,
                                                  Mask<Real>(false), found);
        if (Effects::has(Effect::emission)) reflected = reflected + surface.emission;
        result.radiance = select(found, reflected, result.radiance);
        path.alive = Mask<Real>(false);
    } else {
        const Meeting<Real> meeting = meet(surface, point, to_viewer);
        const Mask<Real> in_glass = meeting.from_inside && surface.transmission > zero;
        path.absorb(scene, hit.t, select(in_glass, surface.material, UInt<Real>(no_medium)), found);
        const Mask<Real> holes = found && !surface.opaque;
        if (Effects::has(Effect::cutouts)) found = found && !holes;
        if (Effects::has(Effect::emission)) {
            const Real share = seen_share<Effects>(scene, path, hit, found);
            result.radiance =
                select(found, result.radiance + path.throughput * (surface.emission * share), result.radiance);
        }
        const Surface<Real> scattering = without_transmitted<Effects>(surface, meeting);
        const Mask<Real> goes_on = meeting.is_front && path.scatterings < UInt<Real>(limits.diffuse);
        const auto reflected = reflected_light<Effects>(tracer, scene, scattering, position, to_viewer, point, sample,
                                                        vertex, goes_on, found);
        result.radiance = select(found, result.radiance + path.throughput * reflected, result.radiance);
        if (!has_bounces<Effects>()) {
            path.alive = Mask<Real>(false);
            return;
        }
        PathState<Effects, Real> onward = path;
        onward.alive = found;
        const Mask<Real> lost = scatter<Effects>(scene, limits, sample, vertex, scattering, point, meeting, onward);
        result.lost_media = result.lost_media + select(lost, UInt<Real>(1U), UInt<Real>(0U));
        if (Effects::has(Effect::cutouts) && any(holes)) {
            path.alive = holes;
            pass_through(point, meeting, holes, path);
            path = select(holes, path, onward);
        } else {
            path = onward;
        }
    }
}

}  // namespace tandem
