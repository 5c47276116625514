/// The path loop: what comes back along a camera ray. So far a path has one vertex, shaded by Phong's model.
#pragma once

#include "tandem/geometry/ray_source.h"
#include "tandem/integrator/surface.h"
#include "tandem/material/phong.h"
#include "tandem/scene/scene_view.h"

namespace tandem {

/// Radiance along `ray`, RGB, linear. `Tracer` is a LoopTracer (geometry/intersect.h) or has its functions, and
/// `kinds`, the PrimitiveKinds that it finds. Lanes outside `active` return anything.
template <class Real, class Tracer>
TANDEM_HD Vec3<Real> radiance(const Tracer& tracer, const SceneView& scene, const Ray<Real>& ray,
                              const Mask<Real>& active) {
    using D = Double<Real>;
    const Closest<Real> hit = tracer.closest(ray, NoSource{}, active);
    const Mask<Real> found = active && hit.primitive != UInt<Real>(no_primitive);
    Vec3<Real> result = {Real(0.0F), Real(0.0F), Real(0.0F)};
    if (!all(found)) result = background(scene.environment, ray.direction);
    if (!any(found)) return result;

    const Surface<Real> surface = surface_at<Tracer::kinds>(scene, ray, hit, found);
    const Vec3<D> direction = widen(ray.direction);
    const Vec3<D> origin = widen(ray.origin);
    const Vec3<D> position = {origin.x + hit.t * direction.x, origin.y + hit.t * direction.y,
                              origin.z + hit.t * direction.z};
    const Vec3<D> to_viewer = -normalize(direction);
    Vec3<Real> reflected = surface.ambient * broadcast<Real>(scene.environment.ambient);
    for (std::uint32_t i = 0; i < scene.light_count; ++i) {
        const PointLight& light = scene.lights[i];
        const Vec3<D> to_light = normalize(broadcast<D>(light.position) - position);
        reflected = reflected + phong_light(surface.diffuse, surface.specular, surface.shininess, light.intensity,
                                            surface.normal, to_light, to_viewer);
    }
    return select(found, reflected, result);
}

}  // namespace tandem
