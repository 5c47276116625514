/// Area lights at a vertex of a path.
#pragma once

#include "tandem/kernel/incident_light.h"
#include "tandem/kernel/light_texture.h"
#include "tandem/kernel/lights/quad_light.h"
#include "tandem/kernel/lights/sphere_light.h"

namespace tandem {

namespace area_lights_detail {

/// Whether a kind of primitive can be an area light. Other emissive primitives are found by paths only.
template <class Body>
inline constexpr bool is_light = is_face<Body> || std::is_same_v<Body, Sphere>;

// A light as seen from a point. `halves_overlap`: as AreaLight has it; the density does not depend on it.
template <class Real>
TANDEM_HD_INLINE SphereLightView<Real> view_light(const Sphere& sphere, const Vec3<Double<Real>>& point, bool) {
    using D = Double<Real>;
    return view_sphere_light<Real>(point, broadcast<D>(sphere.centre), D(sphere.radius));
}
template <class Real>
TANDEM_HD_INLINE TriangleLightView<Real> view_light(const Triangle& face, const Vec3<Double<Real>>& point, bool) {
    using D = Double<Real>;
    return view_triangle_light<Real>(point, broadcast<D>(face.v0), broadcast<D>(face.v1), broadcast<D>(face.v2));
}
template <class Real>
TANDEM_HD_INLINE QuadLightView<Real> view_light(const Quad& face, const Vec3<Double<Real>>& point,
                                                bool halves_overlap) {
    using D = Double<Real>;
    return view_quad_light<Real>(point, broadcast<D>(face.v0), broadcast<D>(face.v1), broadcast<D>(face.v2),
                                 broadcast<D>(face.v3), {face.attributes.sides, halves_overlap});
}

/// Whether the light emits towards the lit `point`; `direction`: unit, from the point to the light. A sphere emits
/// outward, a face from its front, or from both sides if it is double-sided. For quads, view_quad_light() decides by
/// half.
template <class Real>
TANDEM_HD_INLINE Mask<Real> shines(const Sphere& sphere, const Vec3<Double<Real>>& point, const Vec3<Double<Real>>&) {
    using D = Double<Real>;
    const Vec3<D> offset = point - broadcast<D>(sphere.centre);
    return dot(offset, offset) > D(sphere.radius) * D(sphere.radius);
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> shines(const Triangle& face, const Vec3<Double<Real>>&,
                                   const Vec3<Double<Real>>& direction) {
    if (is_double_sided(face.attributes)) return Mask<Real>(true);
    return dot(direction, geometric_normal<Real>(face.v0, face.v1, face.v2)) < Double<Real>(0.0);
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> shines(const Quad&, const Vec3<Double<Real>>&, const Vec3<Double<Real>>&) {
    return Mask<Real>(true);
}

}  // namespace area_lights_detail

/// The lambdas are inlined by force: g++ leaves them as calls otherwise, and scenes with area lights take a tenth
/// longer.
///
/// One area light, sampled with AreaLight's probabilities, at a vertex, in the lanes of `active`.
/// Source: P. Shirley et al., 1996 (kernel/lights/sphere_light.h).
template <class Effects, class Real>
TANDEM_HD_CALL_ON(host)
IncidentLight<Real> sample_area_light(const SceneView& scene, const LitVertex<Real>& at, const Mask<Real>& active) {
    using D = Double<Real>;
    using Word = UInt<Real>;
    const D zero(0.0);
    const Real nothing(0.0F);
    const auto random = at.sample.block_at_vertex(Dimension::area_light, at.number);
    const D u = widen(to_unit_interval<Real>(random.word[1]));
    const D v = widen(to_unit_interval<Real>(random.word[2]));
    Word light(0U);
    for (int i = 0; i < RealTraits<Real>::lanes && known_area_lights() != KnownAreaLights::one; ++i) {
        const std::uint64_t number = std::uint64_t{lane(random.word[0], i)} << 32 | lane(random.word[3], i);
        set_lane(light, i, choose_area_light(scene.area_lights, scene.area_light_count, number));
    }
    const Vec3<D> position = widen(at.point.position);
    LightSample<Real> drawn = {{zero, zero, zero}, {zero, zero, zero}, zero, zero};
    Vec3<Real> radiance = black<Real>();
    Word primitive(no_primitive);
    for_each_unique_lane(
        light, active, [&](std::uint32_t index, const Mask<Real>& here) __attribute__((always_inline)) {
            const AreaLight& chosen = scene.area_lights[index];
            const std::uint32_t material = scene.material_of[chosen.primitive];
            LightSample<Real> of_light = drawn;
            Vec3<Real> emitted = broadcast<Real>(scene.optics[material].emission);
            Mask<Real> lights = here && at.point.primitive != Word(chosen.primitive);
            visit_primitive(
                scene, chosen.primitive, [&](const auto& body) __attribute__((always_inline)) {
                    using Body = std::decay_t<decltype(body)>;
                    if constexpr (area_lights_detail::is_light<Body>) {
                        if (!may_emit_light(kind_of<Body>)) return;
                        of_light = sample_light(
                            area_lights_detail::view_light<Real>(body, position, chosen.halves_overlap != 0), u, v);
                        lights = lights && area_lights_detail::shines<Real>(body, position, of_light.direction);
                        if (!Effects::has(Effect::textures) || !has_textures(scene.textures)) return;
                        const MaterialTextures& textures = scene.textures.materials[material];
                        if (textures.emission.texture == no_texture) return;
                        emitted = emitted * light_texture_factor<Real>(scene, textures, body, of_light);
                    }
                });
            D pdf = select(lights, of_light.pdf, zero);
            if (known_area_lights() != KnownAreaLights::one) pdf = pdf * constant<D>(chosen.probability);
            drawn.direction = select(here, of_light.direction, drawn.direction);
            drawn.point = select(here, of_light.point, drawn.point);
            drawn.pdf = select(here, pdf, drawn.pdf);
            radiance = select(here, emitted, radiance);
            primitive = select(here, Word(chosen.primitive), primitive);
        });
    IncidentLight<Real> result = {{nothing, nothing, nothing}, to_real<Real>(drawn.point), primitive};
    result.casts_shadows = Mask<Real>(scene.area_lights_cast_shadows != 0);
    Mask<Real> seen = active && drawn.pdf > zero;
    if (scene.area_lights_cast_shadows != 0) seen = seen && is_in_front(at, drawn.direction);
    if (!any(seen)) return result;
    const D pdf = select(seen, drawn.pdf, D(1.0));
    const Vec3<Real> value = reflect_light<Effects>(scene, at, radiance * light_scale<Real>(pdf), drawn.direction, pdf);
    result.reflected = select(seen, value, result.reflected);
    return result;
}

/// The density, 1/sr, with which sample_area_light() samples `direction` from `point`, where `primitive` is hit; 0 if
/// that is no area light.
template <class Real>
TANDEM_HD_CALL_ON(host)
Double<Real> area_light_pdf(const SceneView& scene, const UInt<Real>& primitive, const Vec3<Double<Real>>& point,
                            const Vec3<Double<Real>>& direction, const Mask<Real>& active) {
    using D = Double<Real>;
    D result(0.0);
    for_each_unique_lane(
        primitive, active, [&](std::uint32_t id, const Mask<Real>& here) __attribute__((always_inline)) {
            const double probability = probability_of(scene.area_lights, scene.area_light_count, id);
            if (!(probability > 0.0)) return;
            visit_primitive(
                scene, id, [&](const auto& body) __attribute__((always_inline)) {
                    using Body = std::decay_t<decltype(body)>;
                    if constexpr (area_lights_detail::is_light<Body>) {
                        if (!may_emit_light(kind_of<Body>)) return;
                        const D of_light = pdf_of(area_lights_detail::view_light<Real>(body, point, false), direction);
                        result = select(here, of_light * constant<D>(probability), result);
                    }
                });
        });
    return result;
}

struct AreaLights {
    template <class Effects>
    TANDEM_HD_INLINE static std::uint32_t count(const SceneView& scene) {
        return known_area_lights() != KnownAreaLights::unknown || scene.area_light_count > 0 ? 1 : 0;
    }
    template <class Effects, class Real>
    TANDEM_HD_INLINE static IncidentLight<Real> sample(const SceneView& scene, std::uint32_t, const LitVertex<Real>& at,
                                                       const Mask<Real>& active) {
        return sample_area_light<Effects>(scene, at, active);
    }
};

}  // namespace tandem
