/// The light that a vertex of a path receives from the lights, and what Phong's model makes of it.
#pragma once

#include "tandem/geometry/spawn_ray.h"
#include "tandem/integrator/surface.h"
#include "tandem/light/punctual_light.h"
#include "tandem/material/phong.h"

namespace tandem {

/// Is the light stopped on its way to `point`, in the lanes of `active`?
template <class Effects, class Real, class Tracer>
TANDEM_HD Mask<Real> is_shadowed(const Tracer& tracer, const PunctualLight& light, const SurfacePoint<Real>& point,
                                 const Mask<Real>& active) {
    const UInt<Real> no_shape(no_primitive);
    if (Effects::has(Effect::directional_lights) && light.kind == PunctualKind::directional) {
        const SpawnedRay<Real> ray = spawn_ray(point, broadcast<Real>(-light.direction));
        const ShadowSource<Real> source = {ray.source, no_shape};
        return tracer.occluded(ray.ray, Double<Real>(__builtin_huge_val()), source, active);
    }
    const ShadowRay<Real> ray = spawn_shadow_ray(point, broadcast<Real>(light.position), no_shape);
    const Mask<Real> reaches = active && ray.active;
    return (active && !ray.active) || tracer.occluded(ray.ray, ray.t_max, ray.source, reaches);
}

/// Phong's sum over the lights, with the ambient term, at `position` in the lanes of `found`. `point`: the same on the
/// surface, for shadow rays; not looked at without the effect.
template <class Effects, class Real, class Tracer>
TANDEM_HD Vec3<Real> reflected_light(const Tracer& tracer, const SceneView& scene, const Surface<Real>& surface,
                                     const Vec3<Double<Real>>& position, const Vec3<Double<Real>>& to_viewer,
                                     const SurfacePoint<Real>& point, const Mask<Real>& found) {
    const Vec3<Real> black = {Real(0.0F), Real(0.0F), Real(0.0F)};
    Vec3<Real> reflected = surface.ambient * broadcast<Real>(scene.environment.ambient);
    for (std::uint32_t i = 0; i < scene.light_count; ++i) {
        const PunctualLight& light = scene.lights[i];
        const LightRay<Real> ray = light_at<Effects, Real>(light, position);
        Vec3<Real> value = phong_light(surface.diffuse, surface.specular, surface.shininess, ray.intensity,
                                       surface.normal, ray.to_light, to_viewer);
        if (Effects::has(Effect::shadows) && light.casts_shadows != 0) {
            const Mask<Real> lit = found && norm1(value) > Real(0.0F);
            if (any(lit)) {
                const Mask<Real> dark = is_shadowed<Effects>(tracer, light, point, lit);
                value = select(dark, black, value);
            }
        }
        reflected = reflected + value;
    }
    return reflected;
}

}  // namespace tandem
