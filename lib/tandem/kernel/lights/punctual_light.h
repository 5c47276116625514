/// Punctual lights: point, spot and directional lights.
#pragma once

#include "tandem/effects/effects.h"
#include "tandem/math/vec.h"

namespace tandem {

enum class PunctualKind : std::uint32_t { point, spot, directional };

/// Render space, metres. `intensity`: RGB, the id and is of Phong's model. Without fall-off it is the same at every
/// surface, as in the paper. With fall-off it is in candela over pi, and a surface receives intensity / distance^2, so
/// that a surface of diffuse reflectance kd is as bright as a Lambertian one of albedo kd.
///
/// Directions and cones are double: a highlight of shininess n multiplies the error of a direction's length by n, and
/// the cosine of a narrow cone rounds to 1 in float.
struct PunctualLight {
    Vec3d direction;     ///< unit, the direction in which light travels; of a spot light the axis of its cone
    double cone_height;  ///< 1 - cosine of the outer angle, the edge of a spot light (scene/light_cone.h)
    double cone_scale;   ///< 1 / (cosine of the inner angle - that of the outer): full intensity inside the inner one
    Vec3f position;      ///< unused for a directional light
    Vec3f intensity;
    PunctualKind kind;
    std::uint32_t inverse_square;  ///< 1: falls off with distance
    std::uint32_t casts_shadows;   ///< 1: occluders block it
    std::uint32_t unused = 0;      ///< otherwise padding bytes, undefined
};
static_assert(sizeof(PunctualLight) == 80, "no byte of a light is undefined; scene_hash() reads all");

/// The direction and intensity of a light at a point.
template <class Real>
struct LightRay {
    Vec3<Double<Real>> to_light;  ///< unit; 0 at the light's own position
    Vec3<Real> intensity;         ///< RGB
};

/// The light at `position`. `Effects`: what the scene may need (effects/effects.h).
///
/// Gives: 0 outside of a spot light's cone. Between its angles the factor is the square of the linearly interpolated
///        cosine, as in KHR_lights_punctual, "inner and outer cone angles". At the light's own position there is no
///        direction, and no light if it falls off. Tested by tests/agree/closed_forms_test.cpp (1e-6 for the inverse
///        square law), tests/agree/effects_test.cpp (the oracle) and the cases M1, M6 and M7 of the hard corpus.
/// Method: computes 1 - cosine of the angle to a spot's axis as sine^2 / (1 + cosine), which does not cancel in narrow
///         cones.
template <class Effects, class Real>
TANDEM_HD LightRay<Real> light_at(const PunctualLight& light, const Vec3<Double<Real>>& position) {
    using D = Double<Real>;
    const D zero(0.0);
    const D one(1.0);
    const Vec3<D> offset = broadcast<D>(light.position) - position;
    LightRay<Real> ray = {normalize(offset), broadcast<Real>(light.intensity)};
    if (Effects::has(Effect::directional_lights) && light.kind == PunctualKind::directional) {
        ray.to_light = -constant<D>(light.direction);
        return ray;
    }
    if (Effects::has(Effect::spot_lights) && light.kind == PunctualKind::spot) {
        const Vec3<D> axis = constant<D>(light.direction);
        const D cosine = -dot(ray.to_light, axis);
        const Vec3<D> sine = cross(ray.to_light, axis);
        const D height = dot(sine, sine) / (one + greater(cosine, zero));
        const D share = (constant<D>(light.cone_height) - height) * constant<D>(light.cone_scale);
        const D clamped = select(cosine > zero, lesser(greater(share, zero), one), zero);
        ray.intensity = ray.intensity * to_real<Real>(clamped * clamped);
    }
    if (Effects::has(Effect::inverse_square) && light.inverse_square != 0) {
        const D distance2 = dot(offset, offset);
        const Mask<Real> apart = distance2 > zero;
        const D scale = select(apart, one / select(apart, distance2, one), zero);
        ray.intensity = {to_real<Real>(widen(ray.intensity.x) * scale), to_real<Real>(widen(ray.intensity.y) * scale),
                         to_real<Real>(widen(ray.intensity.z) * scale)};
    }
    return ray;
}

}  // namespace tandem
