/// The path loop: the radiance along a camera ray. One loop for all effects; an effect that a kernel leaves out costs
/// neither code nor state.
#pragma once

#include "tandem/kernel/direct_light.h"
#include "tandem/kernel/found_light.h"
#include "tandem/kernel/path_limits.h"
#include "tandem/kernel/scatter.h"
#include "tandem/kernel/shape.h"

namespace tandem {

/// Counters, summed over many paths.
template <class Real>
struct PathTally {
    UInt<Real> lost_media = UInt<Real>(0U);  ///< interfaces where the stack of media was inconsistent
    UInt<Real> rays = UInt<Real>(0U);        ///< traced rays, shadow rays included; only if counts_rays()
};

/// find_vertex() out of line, for kernels whose loop is long.
template <class Effects, std::uint32_t kinds, class Real, class From>
TANDEM_HD_CALL_ON(host)
void step_to_vertex(const SceneView& scene, const Ray<Real>& ray, const From& source, const Closest<Real>& hit,
                    const Mask<Real>& found, Vertex<Real>& vertex) {
    find_vertex<Effects, kinds>(scene, ray, source, hit, found, vertex);
}

namespace path_detail {

/// The point of a ray at t.
template <class Real>
TANDEM_HD Vec3<Double<Real>> point_of(const Ray<Real>& ray, const Double<Real>& t) {
    return spawn_detail::along<Real>(widen(ray.origin), widen(ray.direction), t);
}

}  // namespace path_detail

/// The next hit of each path; without bounces it is that of the camera ray.
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
template <class Effects, class Real, class Tracer, class Threads>
requires(!can_bounce<Effects>()) TANDEM_HD
    void advance(const Tracer& tracer, const SceneView& scene, const PathLimits&, const SampleId<Real>& sample,
                 const UInt<Real>& number, const Closest<Real>& hit, const Threads& threads,
                 PathState<Effects, Real>& path, Vec3<Real>& radiance, PathTally<Real>& tally) {
    using D = Double<Real>;
    const NoSource source;
    const Mask<Real> found = path.alive && hit.primitive != UInt<Real>(no_primitive);
    const Mask<Real> missed = path.alive && !found;
    path.alive = Mask<Real>(false);
    if (any(missed)) see_background(scene, missed, path, radiance);
    if (!any(found)) return;
    Vertex<Real> vertex;
    if constexpr (can_leave_surfaces<Effects>()) {
        step_to_vertex<Effects, Tracer::kinds>(scene, path.ray, source, hit, found, vertex);
    } else {
        find_vertex<Effects, Tracer::kinds>(scene, path.ray, source, hit, found, vertex);
    }
    const Vec3<D> position = path_detail::point_of(path.ray, hit.t);
    const Vec3<D> to_viewer = -normalize(widen(path.ray.direction));
    const FollowedLobes<Real> followed{};
    const LitVertex<Real> lit = {vertex.surface, vertex.point, position, to_viewer, followed, sample, number};
    auto reflected = reflected_light<Effects>(tracer, scene, lit, found, threads, tally.rays);
    if (Effects::has(Effect::emission)) reflected = reflected + vertex.surface.emission;
    radiance = select(found, reflected, radiance);
}

/// A vertex of paths after enter_vertex().
template <class Effects, class Real>
struct PathVertex {
    Vertex<Real> surface;
    ShadingFrame<Real> shading;
    Mask<Real> masked = Mask<Real>(false);  ///< the hit is in an open part of an alpha mask
    FollowedLobes<Real> followed;
    LobeWeights<Real> weights;  ///< of the local lobes
};

/// The first stage of a vertex: the surface at the `hit` of each path in `found`, and the light that it emits, which is
/// added to `radiance`. Removes masked hits from `found`.
template <class Effects, std::uint32_t kinds, class Real>
TANDEM_HD void enter_vertex(const SceneView& scene, const PathLimits& limits, const Closest<Real>& hit,
                            Mask<Real>& found, PathState<Effects, Real>& path, Vec3<Real>& radiance,
                            PathVertex<Effects, Real>& at) {
    using D = Double<Real>;
    const PathSource<Real> source = path.source;
    step_to_vertex<Effects, kinds>(scene, path.ray, source, hit, found, at.surface);
    const Surface<Real>& surface = at.surface.surface;
    at.shading = make_shading_frame(surface, at.surface.point, -normalize(widen(path.ray.direction)));
    const Mask<Real> in_glass = at.shading.from_inside && transmits<Effects>(surface.reflectance.lobes);
    path.absorb(scene, hit.t, select(in_glass, surface.material, UInt<Real>(no_medium)), found);
    at.masked = found && !surface.opaque;
    if (Effects::has(Effect::cutouts)) found = found && !at.masked;
    if (Effects::has(Effect::emission)) {
        const Mask<Real> emits = found && norm1(surface.emission) > Real(0.0F);
        const Real share = share_of_found<Effects>(scene, path, hit, at.surface.point, emits);
        // unlit surfaces light nothing: paths from a diffuse surface do not see their emission
        const Mask<Real> dark = Mask<Real>(Effects::has(Effect::indirect)) && surface.unlit && path.pdf > D(0.0);
        radiance = select(found && !dark, radiance + path.throughput * (surface.emission * share), radiance);
    }
    weigh_local_lobes<Effects>(scene, surface, at.surface.point, at.shading, found, at.weights);
    at.followed =
        followed_lobes<Effects>(scene, limits, surface, at.shading, path.scatterings, path.reflections, at.weights);
}

/// The last stage of a vertex: samples the next ray of the paths in `found`, and continues masked ones. Returns the
/// lanes with a mismatch of media (Interface::lost). Without bounces all paths end.
template <class Effects, class Real>
TANDEM_HD Mask<Real> leave_vertex(const SceneView& scene, const PathLimits& limits, const SampleId<Real>& sample,
                                  const UInt<Real>& number, const Closest<Real>& hit, const Mask<Real>& found,
                                  const PathVertex<Effects, Real>& at, PathState<Effects, Real>& path) {
    if (!has_bounces<Effects>()) {
        path.alive = Mask<Real>(false);
        return path.alive;
    }
    path.alive = found;
    const Mask<Real> mismatched = scatter<Effects>(scene, limits, sample, number, at.surface.surface, at.surface.point,
                                                   at.shading, at.weights, path);
    if (Effects::has(Effect::cutouts) && any(at.masked)) continue_through_mask(hit, at.masked, path);
    return mismatched;
}

/// Processes vertex `number` of each path, at the `hit` that next_hit() found, and samples the next ray. Adds the light
/// of the vertex to `radiance`. Paths that end are no longer alive.
///
/// `Effects`: what the kernel simulates (effects/effects.h). Other effects that the scene needs are ignored; effects
/// that it does not need change no bit in strict and precise. `Tracer` has the interface of LoopTracer
/// (kernel/traversal/intersect.h); its `kinds` are the PrimitiveKinds that it finds. `threads`: how they wait for each
/// other (threads.h).
template <class Effects, class Real, class Tracer, class Threads>
requires(can_bounce<Effects>()) TANDEM_HD
    void advance(const Tracer& tracer, const SceneView& scene, const PathLimits& limits, const SampleId<Real>& sample,
                 const UInt<Real>& number, const Closest<Real>& hit, const Threads& threads,
                 PathState<Effects, Real>& path, Vec3<Real>& radiance, PathTally<Real>& tally) {
    Mask<Real> found = path.alive && hit.primitive != UInt<Real>(no_primitive);
    const Mask<Real> missed = path.alive && !found;
    path.alive = found;
    if (any(missed)) see_background(scene, missed, path, radiance);

    threads.gather();
    if (!any(found) && !threads.wait_together()) return;
    PathVertex<Effects, Real> at;
    if (any(found)) enter_vertex<Effects, Tracer::kinds>(scene, limits, hit, found, path, radiance, at);

    const Vec3<Double<Real>> position = path_detail::point_of(path.ray, hit.t);
    const LitVertex<Real> lit = {at.surface.surface, at.surface.point, position, at.shading.to_viewer,
                                 at.followed,        sample,           number};
    const Vec3<Real> reflected = reflected_light<Effects>(tracer, scene, lit, found, threads, tally.rays);
    threads.gather();
    if (!any(path.alive)) return;
    radiance = select(found, radiance + path.throughput * reflected, radiance);

    const Mask<Real> mismatched = leave_vertex<Effects>(scene, limits, sample, number, hit, found, at, path);
    tally.lost_media = tally.lost_media + select(mismatched, UInt<Real>(1U), UInt<Real>(0U));
}

}  // namespace tandem
