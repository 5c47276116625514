/// Punctual lights at a vertex of a path.
#pragma once

#include "tandem/kernel/incident_light.h"
#include "tandem/kernel/lights/punctual_light.h"

namespace tandem {

struct PunctualLights {
    template <class Effects>
    TANDEM_HD static std::uint32_t count(const SceneView& scene) {
        return Effects::light_count(scene.light_count);
    }

    template <class Effects, class Real>
    TANDEM_HD static IncidentLight<Real> sample(const SceneView& scene, std::uint32_t number, const LitVertex<Real>& at,
                                                const Mask<Real>&) {
        const PunctualLight& light = scene.lights[number];
        const LightRay<Real> ray = light_at<Effects, Real>(light, at.position);
        IncidentLight<Real> result;
        result.reflected = reflect_light<Effects>(scene, at, ray.intensity, ray.to_light, OnlyDirection());
        if (Effects::has(Effect::shadows)) {
            const bool is_far = Effects::has(Effect::directional_lights) && light.kind == PunctualKind::directional;
            result.position_or_direction = is_far ? constant<Real>(-light.direction) : broadcast<Real>(light.position);
            result.is_far = Mask<Real>(is_far);
            result.casts_shadows = Mask<Real>(light.casts_shadows != 0);
            if (light.casts_shadows != 0) {
                result.reflected = select(is_in_front(at, ray.to_light), result.reflected, black<Real>());
            }
        }
        return result;
    }
};

}  // namespace tandem
