/// Area lights at a vertex of a path.
#pragma once

#include "tandem/kernel/incident_light.h"
#include "tandem/kernel/light_texture.h"
#include "tandem/kernel/visit_lights.h"

namespace tandem {

namespace area_lights_detail {

// A light as seen from a point, or that of each lane. `halves_overlap`: as AreaLight has it; the density does not
// depend on it.
template <class Real>
TANDEM_HD_INLINE SphereLightView<Real> view_light(const Sphere& sphere, const Vec3<Double<Real>>& point,
                                                  const Mask<Real>&) {
    using D = Double<Real>;
    return view_sphere_light<Real>(point, broadcast<D>(sphere.centre), D(sphere.radius));
}
template <class Real>
TANDEM_HD_INLINE TriangleLightView<Real> view_light(const Triangle& face, const Vec3<Double<Real>>& point,
                                                    const Mask<Real>&) {
    using D = Double<Real>;
    return view_triangle_light<Real>(point, broadcast<D>(face.v0), broadcast<D>(face.v1), broadcast<D>(face.v2));
}
template <class Real>
TANDEM_HD_INLINE QuadLightView<Real> view_light(const Quad& face, const Vec3<Double<Real>>& point,
                                                const Mask<Real>& halves_overlap) {
    using D = Double<Real>;
    return view_quad_light<Real>(point, broadcast<D>(face.v0), broadcast<D>(face.v1), broadcast<D>(face.v2),
                                 broadcast<D>(face.v3), quad_light_shape<Real>(face.attributes.sides, halves_overlap));
}
template <class Real>
TANDEM_HD_INLINE SphereLightView<Real> view_light(const LaneSphere<Real>& sphere, const Vec3<Double<Real>>& point,
                                                  const Mask<Real>&) {
    return view_sphere_light<Real>(point, widen(sphere.centre), widen(sphere.radius));
}
template <class Real>
TANDEM_HD_INLINE TriangleLightView<Real> view_light(const LaneTriangle<Real>& face, const Vec3<Double<Real>>& point,
                                                    const Mask<Real>&) {
    return view_triangle_light<Real>(point, widen(face.v0), widen(face.v1), widen(face.v2));
}
template <class Real>
TANDEM_HD_INLINE QuadLightView<Real> view_light(const LaneQuad<Real>& face, const Vec3<Double<Real>>& point,
                                                const Mask<Real>& halves_overlap) {
    return view_quad_light<Real>(point, widen(face.v0), widen(face.v1), widen(face.v2), widen(face.v3),
                                 {!face.double_sided, face.culled, halves_overlap});
}

/// Whether the light emits towards the lit `point`; `direction`: unit, from the point to the light. A sphere emits
/// outward, a face from its front, or from both sides if it is double-sided. For quads, view_quad_light() decides by
/// half.
template <class Real>
TANDEM_HD_INLINE Mask<Real> is_outside(const Vec3<Double<Real>>& centre, const Double<Real>& radius,
                                       const Vec3<Double<Real>>& point) {
    const Vec3<Double<Real>> offset = point - centre;
    return dot(offset, offset) > radius * radius;
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> shines(const Sphere& sphere, const Vec3<Double<Real>>& point, const Vec3<Double<Real>>&) {
    using D = Double<Real>;
    return is_outside<Real>(broadcast<D>(sphere.centre), D(sphere.radius), point);
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> shines(const LaneSphere<Real>& sphere, const Vec3<Double<Real>>& point,
                                   const Vec3<Double<Real>>&) {
    return is_outside<Real>(widen(sphere.centre), widen(sphere.radius), point);
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> shines(const Triangle& face, const Vec3<Double<Real>>&,
                                   const Vec3<Double<Real>>& direction) {
    if (is_double_sided(face.attributes)) return Mask<Real>(true);
    return dot(direction, geometric_normal<Real>(face.v0, face.v1, face.v2)) < Double<Real>(0.0);
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> shines(const LaneTriangle<Real>& face, const Vec3<Double<Real>>&,
                                   const Vec3<Double<Real>>& direction) {
    return face.double_sided || dot(direction, face.normal) < Double<Real>(0.0);
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> shines(const Quad&, const Vec3<Double<Real>>&, const Vec3<Double<Real>>&) {
    return Mask<Real>(true);
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> shines(const LaneQuad<Real>&, const Vec3<Double<Real>>&, const Vec3<Double<Real>>&) {
    return Mask<Real>(true);
}

/// The emission of `light`, which is `primitive`, at a sampled point: that of its material times its emissive texture.
template <class Effects, class Real, class Light>
TANDEM_HD_INLINE Vec3<Real> emission_at(const SceneView& scene, const Light& light, std::uint32_t primitive,
                                        const LightSample<Real>& drawn) {
    const std::uint32_t material = scene.material_of[primitive];
    const Vec3<Real> emission = broadcast<Real>(scene.optics[material].emission);
    if (!Effects::has(Effect::textures) || !has_textures(scene.textures)) return emission;
    const MaterialTextures& textures = scene.textures.materials[material];
    if (textures.emission.texture == no_texture) return emission;
    return emission * light_texture_factor<Real>(scene, textures, light, drawn);
}

/// The emission of the light of each lane.
template <class Effects, class Real, class Light>
TANDEM_HD_INLINE Vec3<Real> emission_in_lanes(const SceneView& scene, const Light& light, const UInt<Real>& primitive,
                                              const Mask<Real>& here, const LightSample<Real>& drawn) {
    if constexpr (RealTraits<Real>::lanes == 1) {
        return emission_at<Effects>(scene, light, primitive, drawn);
    } else {
        Vec3<Real> emission = black<Real>();
        for_each_unique_lane(primitive, here, [&](std::uint32_t number, const Mask<Real>& lanes) {
            visit_primitive(scene, number, [&](const auto& body) {
                if constexpr (is_light<std::decay_t<decltype(body)>>) {
                    emission = select(lanes, emission_at<Effects>(scene, body, number, drawn), emission);
                }
            });
        });
        return emission;
    }
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
    Word primitive(no_primitive), overlaps(0U);
    D probability(1.0);
    for (int i = 0; i < RealTraits<Real>::lanes; ++i) {
        const std::uint64_t number = std::uint64_t{lane(random.word[0], i)} << 32 | lane(random.word[3], i);
        const bool is_only = known_area_lights() == KnownAreaLights::one;
        const AreaLight& light =
            scene.area_lights[is_only ? 0 : choose_area_light(scene.area_lights, scene.area_light_count, number)];
        set_lane(primitive, i, light.primitive);
        set_lane(overlaps, i, light.halves_overlap);
        if (!is_only) set_lane_constant(probability, i, light.probability);
    }
    const Vec3<D> position = widen(at.point.position);
    LightSample<Real> drawn = {{zero, zero, zero}, {zero, zero, zero}, zero, zero};
    Vec3<Real> radiance = black<Real>();
    visit_lights<Real>(
        scene, primitive, active, [&](const auto& light, const Mask<Real>& here) __attribute__((always_inline)) {
            using namespace area_lights_detail;
            const LightSample<Real> of_light =
                sample_light(view_light<Real>(light, position, overlaps != Word(0U)), u, v);
            const Mask<Real> lights =
                here && at.point.primitive != primitive && shines<Real>(light, position, of_light.direction);
            D pdf = select(lights, of_light.pdf, zero);
            if (known_area_lights() != KnownAreaLights::one) pdf = pdf * probability;
            drawn.direction = select(here, of_light.direction, drawn.direction);
            drawn.point = select(here, of_light.point, drawn.point);
            drawn.pdf = select(here, pdf, drawn.pdf);
            radiance =
                select(here, emission_in_lanes<Effects, Real>(scene, light, primitive, here, of_light), radiance);
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
    D result(0.0), probability(0.0);
    for (int i = 0; i < RealTraits<Real>::lanes; ++i) {
        if (!lane(active, i)) continue;
        set_lane_constant(probability, i,
                          probability_of(scene.area_lights, scene.area_light_count, lane(primitive, i)));
    }
    visit_lights<Real>(
        scene, primitive,
        active && probability > D(0.0), [&](const auto& light, const Mask<Real>& here) __attribute__((always_inline)) {
            const D of_light = pdf_of(area_lights_detail::view_light<Real>(light, point, Mask<Real>(false)), direction);
            result = select(here, of_light * probability, result);
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
