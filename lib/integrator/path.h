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

/// Where rays that leave surfaces need more than `ray.origin + t ray.direction`.
template <class Effects>
TANDEM_HD constexpr bool leaves_surfaces() {
    return Effects::has(Effect::shadows) || has_bounces<Effects>();
}

/// Radiance along `camera_ray`. `Effects`: what is simulated (effects/effects.h); what the scene calls for beyond it is
/// left out, and what it does not call for changes no bit in strict and precise. `Tracer` is a LoopTracer
/// (geometry/intersect.h) or has its functions, and `kinds`, the PrimitiveKinds that it finds. Lanes outside `active`
/// return anything.
template <class Effects, class Real, class Tracer>
TANDEM_HD PathResult<Real> trace_path(const Tracer& tracer, const SceneView& scene, const PathLimits& limits,
                                      const SampleId<Real>& sample, const Ray<Real>& camera_ray,
                                      const Mask<Real>& active) {
    using D = Double<Real>;
    constexpr bool bounces = has_bounces<Effects>();
    using From = std::conditional_t<bounces, Source<Real>, NoSource>;
    const Real zero(0.0F);
    const Vec3<Real> black = {zero, zero, zero};
    PathResult<Real> result = {black};
    PathState<Effects, Real> path(scene, camera_ray, active);
    for (std::uint32_t vertex = 0;; ++vertex) {
        From source{};
        if constexpr (bounces) source = path.source;
        const Closest<Real> hit = tracer.closest(path.ray, source, path.alive);
        const Mask<Real> found = path.alive && hit.primitive != UInt<Real>(no_primitive);
        const Mask<Real> missed = path.alive && !found;
        if (any(missed)) {
            const Vec3<Real> seen = background(scene.environment, path.ray.direction);
            if constexpr (bounces) {
                path.absorb(scene, hit.t, UInt<Real>(no_medium), missed);
                result.radiance = select(missed, result.radiance + path.throughput * seen, result.radiance);
            } else {
                result.radiance = select(missed, seen, result.radiance);
            }
        }
        if (!any(found)) return result;

        const Surface<Real> surface = surface_at<Effects, Tracer::kinds>(scene, path.ray, source, hit, found);
        SurfacePoint<Real> point;
        if constexpr (leaves_surfaces<Effects>()) {
            point = surface_point<Tracer::kinds>(scene, path.ray, source, hit, found);
        }
        const Vec3<D> direction = widen(path.ray.direction);
        const Vec3<D> origin = widen(path.ray.origin);
        const Vec3<D> position = {origin.x + hit.t * direction.x, origin.y + hit.t * direction.y,
                                  origin.z + hit.t * direction.z};
        const Vec3<D> to_viewer = -normalize(direction);
        if constexpr (!bounces) {
            const auto reflected = reflected_light<Effects>(tracer, scene, surface, position, to_viewer, point, found);
            result.radiance = select(found, reflected, result.radiance);
            return result;
        } else {
            const Meeting<Real> meeting = meet(surface, point, to_viewer);
            const Mask<Real> in_glass = meeting.from_inside && surface.transmission > zero;
            path.absorb(scene, hit.t, select(in_glass, surface.material, UInt<Real>(no_medium)), found);
            const auto reflected = reflected_light<Effects>(
                tracer, scene, without_transmitted<Effects>(surface, meeting), position, to_viewer, point, found);
            result.radiance = select(found, result.radiance + path.throughput * reflected, result.radiance);
            path.alive = found;
            const Mask<Real> lost = scatter<Effects>(scene, limits, sample, vertex, surface, point, meeting, path);
            result.lost_media = result.lost_media + select(lost, UInt<Real>(1U), UInt<Real>(0U));
            if (!any(path.alive)) return result;
        }
    }
}

}  // namespace tandem
