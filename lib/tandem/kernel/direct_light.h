/// Direct light at a vertex of a path.
#pragma once

#include "tandem/kernel/area_lights.h"
#include "tandem/kernel/environment_lights.h"
#include "tandem/kernel/light_reservoir.h"
#include "tandem/kernel/punctual_lights.h"
#include "tandem/kernel/shadow.h"
#include "tandem/kernel/threads.h"

namespace tandem {

/// The number of lights that a vertex samples, over all families of lights.def.
template <class Effects>
TANDEM_HD std::uint32_t count_lights(const SceneView& scene) {
    std::uint32_t count = 0;
#define TANDEM_LIGHT(Type, needs, is)                                                 \
    if constexpr (can_simulate<Effects>(needs)) {                                     \
        if (simulates<Effects>(needs)) count += Type::template count<Effects>(scene); \
    }
#include "tandem/kernel/lights/lights.def"
    return count;
}

/// Light `number` of these.
template <class Effects, class Real>
TANDEM_HD IncidentLight<Real> sample_light(const SceneView& scene, std::uint32_t number, const LitVertex<Real>& at,
                                           const Mask<Real>& active) {
#define TANDEM_LIGHT(Type, needs, is)                                                                 \
    if constexpr (can_simulate<Effects>(needs)) {                                                     \
        if (simulates<Effects>(needs)) {                                                              \
            const std::uint32_t of_family = Type::template count<Effects>(scene);                     \
            if (number < of_family) return Type::template sample<Effects>(scene, number, at, active); \
            number -= of_family;                                                                      \
        }                                                                                             \
    }
#include "tandem/kernel/lights/lights.def"
    return {black<Real>(), black<Real>()};
}

/// The ambient term at a vertex.
template <class Real>
TANDEM_HD Vec3<Real> ambient_light(const SceneView& scene, const LitVertex<Real>& at) {
    return at.surface.reflectance.ambient * broadcast<Real>(scene.environment.ambient);
}

/// Whether vertices sample one of several lights.
template <class Effects>
TANDEM_HD bool chooses_light(const SceneView& scene, std::uint32_t count) {
    return has_indirect_light<Effects>(scene) && count > 1;
}
template <class Real>
TANDEM_HD LightReservoir<Real> begin_choice(const LitVertex<Real>& at, bool by_chance) {
    return LightReservoir<Real>(by_chance ? light_choice<Real>(at.sample, at.number) : PhiloxBlock<UInt<Real>>{});
}

/// Whether no vertex sends more than one shadow ray.
template <class Effects>
TANDEM_HD bool samples_one_light(const SceneView& scene) {
    const std::uint32_t count = count_lights<Effects>(scene);
    return count <= 1 || chooses_light<Effects>(scene, count);
}

/// The light that a vertex of such a scene samples, in the lanes of `reflects`, before its shadow ray is traced.
template <class Effects, class Real>
TANDEM_HD IncidentLight<Real> sample_one_light(const SceneView& scene, const LitVertex<Real>& at,
                                               const Mask<Real>& reflects) {
    const std::uint32_t count = count_lights<Effects>(scene);
    const bool by_chance = chooses_light<Effects>(scene, count);
    auto choice = begin_choice<Real>(at, by_chance);
    IncidentLight<Real> light = {black<Real>(), black<Real>()};
    for (std::uint32_t i = 0; i < count; ++i) {
        light = sample_light<Effects>(scene, i, at, reflects);
        if (by_chance) choice.offer(light);
    }
    return by_chance ? choice.chosen() : light;
}

/// Whether the light at a vertex needs a shadow ray, in the lanes of `reflects`.
template <class Real>
TANDEM_HD Mask<Real> needs_shadow_ray(const IncidentLight<Real>& light, const Mask<Real>& reflects) {
    return reflects && light.casts_shadows && norm1(light.reflected) > Real(0.0F);
}

/// The reflected light of all lights at a vertex, and the ambient term, in the lanes of `found`. With indirect light,
/// each vertex samples one light (LightReservoir). One loop covers all families of lights, so that shadow rays are
/// traced in one place. `rays` counts them. `threads`: as IndependentThreads.
template <class Effects, class Real, class Tracer, class Threads>
TANDEM_HD Vec3<Real> reflected_light(const Tracer& tracer, const SceneView& scene, const LitVertex<Real>& at,
                                     const Mask<Real>& found, const Threads& threads, UInt<Real>& rays) {
    Vec3<Real> reflected = ambient_light(scene, at);
    const Mask<Real> reflects = found && scatters<Effects>(at.surface.reflectance.lobes);
    const bool any_reflects = any(reflects);
    if (!any_reflects && !threads.wait_together()) return reflected;
    const std::uint32_t count = count_lights<Effects>(scene);
    const bool by_chance = chooses_light<Effects>(scene, count);
    auto choice = begin_choice<Real>(at, by_chance);
    // one more iteration for the chosen light, so that shadow rays are traced in one place
    for (std::uint32_t i = 0; i < count + (by_chance ? 1U : 0U); ++i) {
        IncidentLight<Real> light = {black<Real>(), black<Real>()};
        if (any_reflects) {  // threads without such a lane iterate too
            light = i == count ? choice.chosen() : sample_light<Effects>(scene, i, at, reflects);
        }
        if (by_chance && i < count) {
            choice.offer(light);
            continue;
        }
        if (Effects::has(Effect::shadows)) {
            threads.gather();
            const Mask<Real> lit = needs_shadow_ray(light, reflects);
            if (any(lit)) {
                const Mask<Real> dark = is_blocked<Effects>(tracer, scene, light, at.point, lit, rays);
                light.reflected = select(dark, black<Real>(), light.reflected);
            }
        }
        reflected = reflected + light.reflected;
    }
    return reflected;
}

}  // namespace tandem
