/// Lights without extent: points, spots and directions.
#pragma once

#include "tandem/effects/effects.h"
#include "tandem/math/vec.h"

namespace tandem {

enum class PunctualKind : std::uint32_t { point, spot, directional };

/// Render space, metres. `intensity`: RGB, the id and is of Phong's model. Without fall-off it reaches every surface as
/// it is, as in the paper; with it, it is in candela over pi, and what reaches a surface is intensity / distance^2, so
/// that a surface of diffuse reflectance kd is as bright as a Lambertian one of albedo kd.
struct PunctualLight {
    Vec3f position;  ///< of a directional light nothing
    Vec3f intensity;
    Vec3f direction;   ///< unit, the way that the light goes; of a spot light the axis of its cone
    float cos_outer;   ///< a spot light brings nothing outside of this angle from its axis
    float cone_scale;  ///< 1 / (cosine of the inner angle - cos_outer): inside of the inner angle all its light
    PunctualKind kind;
    std::uint32_t inverse_square;  ///< 1: falls off with distance
    std::uint32_t casts_shadows;   ///< 1: stopped by what stands in its way
};

/// How a light reaches a point.
template <class Real>
struct LightRay {
    Vec3<Double<Real>> to_light;  ///< unit
    Vec3<Real> intensity;         ///< RGB
};

/// The light at `position`. `Effects`: what the scene may call for (effects/effects.h).
///
/// Gives: 0 outside of a spot light's cone; the fall-off between its angles is the square of the cosine's share, as in
///        KHR_lights_punctual, "inner and outer cone angles". Held by tests/agree/closed_forms_test.cpp (1e-6 of the
///        law of the distance) and tests/agree/effects_test.cpp (the oracle).
template <class Effects, class Real>
TANDEM_HD LightRay<Real> light_at(const PunctualLight& light, const Vec3<Double<Real>>& position) {
    using D = Double<Real>;
    const Vec3<D> offset = broadcast<D>(light.position) - position;
    LightRay<Real> ray = {normalize(offset), broadcast<Real>(light.intensity)};
    if (Effects::has(Effect::directional_lights) && light.kind == PunctualKind::directional) {
        ray.to_light = -broadcast<D>(light.direction);
        return ray;
    }
    if (Effects::has(Effect::spot_lights) && light.kind == PunctualKind::spot) {
        const D cosine = -dot(ray.to_light, broadcast<D>(light.direction));
        const D share = (cosine - D(light.cos_outer)) * D(light.cone_scale);
        const D clamped = lesser(greater(share, D(0.0)), D(1.0));
        ray.intensity = ray.intensity * to_real<Real>(clamped * clamped);
    }
    if (Effects::has(Effect::inverse_square) && light.inverse_square != 0) {
        const D scale = D(1.0) / dot(offset, offset);
        ray.intensity = {to_real<Real>(widen(ray.intensity.x) * scale), to_real<Real>(widen(ray.intensity.y) * scale),
                         to_real<Real>(widen(ray.intensity.z) * scale)};
    }
    return ray;
}

}  // namespace tandem
