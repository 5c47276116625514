/// Direct light at a vertex of a path, and what the surface reflects of it.
#pragma once

#include "tandem/kernel/area_light_sampling.h"
#include "tandem/kernel/block_barrier.h"
#include "tandem/kernel/bsdf/phong.h"
#include "tandem/kernel/light_reservoir.h"
#include "tandem/kernel/lights/punctual_light.h"
#include "tandem/kernel/shadow.h"
#include "tandem/kernel/surroundings.h"

namespace tandem {

template <class Effects, class Real>
TANDEM_HD IncidentLight<Real> punctual_light(const PunctualLight& light, const Surface<Real>& surface,
                                             const SurfacePoint<Real>& point, const Vec3<Double<Real>>& position,
                                             const Vec3<Double<Real>>& to_viewer) {
    const LightRay<Real> ray = light_at<Effects, Real>(light, position);
    IncidentLight<Real> result;
    result.reflected = phong_light(surface.diffuse, surface.specular, surface.shininess, ray.intensity, surface.normal,
                                   ray.to_light, to_viewer);
    if (Effects::has(Effect::microfacets) && any(surface.has_microfacets)) {
        const auto value = facets_light<Real>(surface, point, ray.intensity, ray.to_light, to_viewer, Real(1.0F),
                                              Double<Real>(1.0F), FollowedLobes<Real>());
        result.reflected = select(surface.has_microfacets, value, result.reflected);
    }
    if (Effects::has(Effect::shadows)) {
        const bool is_far = Effects::has(Effect::directional_lights) && light.kind == PunctualKind::directional;
        result.to = is_far ? constant<Real>(-light.direction) : broadcast<Real>(light.position);
        result.is_far = Mask<Real>(is_far);
        result.casts_shadows = Mask<Real>(light.casts_shadows != 0);
        if (light.casts_shadows != 0) keep_in_front(surface, point, ray.to_light, result);
    }
    return result;
}

/// The sum over all lights, with the ambient term, at `position` in the lanes of `found`. `point`: the same on the
/// surface, for shadow rays. `followed`: the lobes that the path may follow here, and then hit lights by itself. With
/// indirect light, each vertex samples one light (LightReservoir). One loop covers all kinds of lights, so that a
/// kernel starts shadow rays in one place. `rays` counts them.
template <class Effects, class Real, class Tracer>
TANDEM_HD Vec3<Real> reflected_light(const Tracer& tracer, const SceneView& scene, const Surface<Real>& surface,
                                     const Vec3<Double<Real>>& position, const Vec3<Double<Real>>& to_viewer,
                                     const SurfacePoint<Real>& point, const SampleId<Real>& sample,
                                     const UInt<Real>& vertex, const FollowedLobes<Real>& followed,
                                     const Mask<Real>& found, UInt<Real>& rays) {
    const Vec3<Real> black = {Real(0.0F), Real(0.0F), Real(0.0F)};
    Vec3<Real> reflected = surface.ambient * broadcast<Real>(scene.environment.ambient);
    Mask<Real> reflects = found && norm1(surface.diffuse) + norm1(surface.specular) > Real(0.0F);
    if (Effects::has(Effect::microfacets)) reflects = reflects || (found && surface.has_microfacets);
    const bool any_reflects = any(reflects);
    if (!any_reflects && !keeps_together<Effects>()) return reflected;
    const bool area = Effects::has(Effect::area_lights) && scene.area_light_count > 0;
    const bool indirect = Effects::has(Effect::indirect) && scene.environment.indirect != 0;
    const bool picture = samples_environment_picture<Effects>(scene);
    const bool sky =
        picture || (Effects::has(Effect::environment_light) && scene.environment.illuminates != 0 && !indirect);
    const std::uint32_t punctual = Effects::light_count(scene.light_count);
    const std::uint32_t count = punctual + (area ? 1U : 0U) + (sky ? 1U : 0U);
    const bool by_chance = indirect && count > 1;
    LightReservoir<Real> choice(by_chance ? light_choice<Real>(sample, vertex) : PhiloxBlock<UInt<Real>>{});
    // one more iteration, for the chosen light: so shadow rays start in one place
    for (std::uint32_t i = 0; i < count + (by_chance ? 1U : 0U); ++i) {
        IncidentLight<Real> light = {black, black};
        if (any_reflects) {  // threads without any iterate as well: those of a block synchronise
            if (i < punctual) {
                light = punctual_light<Effects, Real>(scene.lights[i], surface, point, position, to_viewer);
            } else if (i == count) {
                light = choice.chosen();
            } else if (area && i == punctual) {
                light = area_light<Effects>(scene, surface, point, to_viewer, sample, vertex, followed, reflects);
            } else if (picture) {
                light = environment_picture_light<Effects>(scene, surface, point, to_viewer, sample, vertex, followed);
            } else if (sky) {
                light = environment_light<Effects>(scene, surface, point, to_viewer, sample, vertex);
            }
        }
        if (by_chance && i < count) {
            choice.offer(light);
            continue;
        }
        if (Effects::has(Effect::shadows)) {
            gather_block<Effects>();
            const Mask<Real> lit = reflects && light.casts_shadows && norm1(light.reflected) > Real(0.0F);
            if (any(lit)) {
                const Mask<Real> dark = is_stopped<Effects>(tracer, scene, light, point, lit, rays);
                light.reflected = select(dark, black, light.reflected);
            }
        }
        reflected = reflected + light.reflected;
    }
    return reflected;
}

}  // namespace tandem
