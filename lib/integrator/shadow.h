/// Shadow rays: is light stopped on its way to a point?
#pragma once

#include "tandem/integrator/incident_light.h"
#include "tandem/integrator/surface.h"

namespace tandem {

namespace shadow_detail {

template <class Real, class From, class Tracer>
TANDEM_HD_SHARED Closest<Real> closest_by_call(const Tracer& tracer, Ray<Real> ray, From source, Mask<Real> active) {
    return tracer.closest(ray, source, active);
}

}  // namespace shadow_detail

/// Tracer::closest(). Where it is asked from two places, by paths and by their shadow rays, these share one copy.
template <class Effects, class Real, class From, class Tracer>
TANDEM_HD Closest<Real> nearest_hit(const Tracer& tracer, const Ray<Real>& ray, const From& source,
                                    const Mask<Real>& active) {
    if (Effects::has(Effect::cutouts)) return shadow_detail::closest_by_call<Real>(tracer, ray, source, active);
    return tracer.closest(ray, source, active);
}

/// Tracer::occluded(), with holes where materials are cut out. `to`: where a ray of finite length leads, from wherever
/// it goes on; null for a direction.
template <class Effects, class Real, class Tracer>
TANDEM_HD Mask<Real> is_stopped_by_opaque(const Tracer& tracer, const SceneView& scene, Ray<Real> ray,
                                          const ShadowSource<Real>& from, const Double<Real>& t_max,
                                          const Vec3<Real>* to, const Mask<Real>& active) {
    if (!Effects::has(Effect::cutouts) || (!is_linked && scene.has_cutouts == 0)) {
        return tracer.occluded(ray, t_max, from, active);
    }
    Source<Real> source = from;
    Mask<Real> open = active;
    Mask<Real> stopped(false);
    for (std::uint32_t holes = 0; holes < most_holes; ++holes) {
        const Closest<Real> hit = nearest_hit<Effects>(tracer, ray, source, open);
        const Mask<Real> met = open && hit.primitive != UInt<Real>(no_primitive) && hit.t < t_max;
        if (!any(met)) return stopped;
        const Mask<Real> passes =
            hit.primitive == from.light || !is_opaque_at<Tracer::kinds>(scene, ray, source, hit, met);
        stopped = stopped || (met && !passes);
        open = met && passes;
        if (!any(open)) return stopped;
        const SurfacePoint<Real> point = surface_point<Tracer::kinds>(scene, ray, source, hit, open);
        const Mask<Real> inside = dot(widen(ray.direction), point.normal) < Double<Real>(0.0);
        ray.origin = select(open, departure(point, inside), ray.origin);
        if (to != nullptr) {
            ray.direction = select(open, to_real<Real>(widen(*to) - widen(ray.origin)), ray.direction);
            open = open && is_traceable(ray);
        }
        source = {point.primitive, inside};
    }
    return stopped || open;
}

/// Is `light` stopped on its way to `point`, in the lanes of `active`? One at the very point brings nothing.
template <class Effects, class Real, class Tracer>
TANDEM_HD_STEP Mask<Real> is_stopped(const Tracer& tracer, const SceneView& scene, const IncidentLight<Real>& light,
                                     const SurfacePoint<Real>& point, const Mask<Real>& active) {
    ShadowRay<Real> shadow;
    if (light.is_far) {
        const SpawnedRay<Real> ray = spawn_ray(point, light.to);
        shadow = {ray.ray, {ray.source, UInt<Real>(no_primitive)}, Double<Real>(__builtin_huge_val()), active};
    } else {
        shadow = spawn_shadow_ray(point, light.to, light.primitive);
        shadow.active = shadow.active && active;
    }
    const Vec3<Real>* to = light.is_far ? nullptr : &light.to;
    return (active && !shadow.active) ||
           is_stopped_by_opaque<Effects>(tracer, scene, shadow.ray, shadow.source, shadow.t_max, to, shadow.active);
}

}  // namespace tandem
