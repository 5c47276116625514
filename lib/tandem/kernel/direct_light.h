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

/// The reflected light of all lights at a vertex, and the ambient term, in the lanes of `found`. With indirect light,
/// each vertex samples one light (LightReservoir). One loop covers all families of lights, so that shadow rays are
/// traced in one place. `rays` counts them. `threads`: as IndependentThreads.
template <class Effects, class Real, class Tracer, class Threads>
TANDEM_HD Vec3<Real> reflected_light(const Tracer& tracer, const SceneView& scene, const LitVertex<Real>& at,
                                     const Mask<Real>& found, const Threads& threads, UInt<Real>& rays) {
    Vec3<Real> reflected = at.surface.reflectance.ambient * broadcast<Real>(scene.environment.ambient);
    const Mask<Real> reflects = found && scatters<Effects>(at.surface.reflectance.lobes);
    const bool any_reflects = any(reflects);
    if (!any_reflects && !threads.wait_together()) return reflected;
    const std::uint32_t count = count_lights<Effects>(scene);
    const bool by_chance = has_indirect_light<Effects>(scene) && count > 1;
    LightReservoir<Real> choice(by_chance ? light_choice<Real>(at.sample, at.number) : PhiloxBlock<UInt<Real>>{});
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
            const Mask<Real> lit = reflects && light.casts_shadows && norm1(light.reflected) > Real(0.0F);
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
