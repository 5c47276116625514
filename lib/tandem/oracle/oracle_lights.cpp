#include "tandem/oracle/oracle_lights.h"

#include <algorithm>
#include <cmath>

#include "tandem/oracle/oracle_environment.h"

namespace tandem::oracle {

namespace {

bool is_shadowed(const BoundedView& scene, const PunctualLight& light, const Vertex& vertex) {
    const bool directional = light.kind == PunctualKind::directional;
    const Vector to_light = directional ? to_vector(light.direction) * -1 : to_vector(light.position) - vertex.point;
    if (!is_in_front(vertex, to_light)) return true;  // below the surface itself, or exactly at the point
    return is_blocked(scene, vertex, to_light, directional ? HUGE_VALL : 1 - rounding);
}

/// The light that arrives at a point, ignoring shadows, and the unit direction to its source.
Vector light_at(const PunctualLight& light, const Vector& point, Vector& to_light) {
    Vector intensity = to_vector(light.intensity);
    if (light.kind == PunctualKind::directional) {
        to_light = to_vector(light.direction) * -1;
        return intensity;
    }
    const Vector offset = to_vector(light.position) - point;
    to_light = offset;
    if (inner(offset, offset) == 0) return light.inverse_square != 0 ? Vector{0, 0, 0} : intensity;
    to_light = unit(offset);
    if (light.kind == PunctualKind::spot) {
        const Vector axis = to_vector(light.direction);
        const Vector chord =
            to_light + axis;  // from the axis to the direction towards the point; its square is 2 - 2 cos
        const Real share = (Real{light.cone_height} - inner(chord, chord) / 2) * Real{light.cone_scale};
        intensity = intensity * std::pow(std::clamp<Real>(share, 0, 1), 2);
    }
    if (light.inverse_square != 0) intensity = intensity * (1 / inner(offset, offset));
    return intensity;
}

/// A point of an emissive surface.
struct LightPoint {
    Vector point;
    SurfaceHit hit;  ///< its normal, corners and weights
    Real area = 0;   ///< of the whole surface
};

/// Uniform in the area.
LightPoint point_of_light(const SceneView& scene, std::uint32_t id, Chance& chance) {
    LightPoint light{};
    const auto on_triangle = [&](const Vec3f& a, const Vec3f& b, const Vec3f& c, std::uint32_t second) {
        const Vector e1 = to_vector(b) - to_vector(a), e2 = to_vector(c) - to_vector(a);
        const Vector twice = {e1.y * e2.z - e1.z * e2.y, e1.z * e2.x - e1.x * e2.z, e1.x * e2.y - e1.y * e2.x};
        const Real root = std::sqrt(chance());
        const Real along = root * chance();
        light.point = to_vector(a) + e1 * along + e2 * (1 - root);
        light.hit.normal = unit(twice);
        light.hit.corner[1] = second;
        light.hit.corner[2] = second + 1;
        light.hit.weight = {root - along, along, 1 - root};
        return std::sqrt(inner(twice, twice)) / 2;
    };
    visit_primitive(scene, id, [&](const auto& body) {
        using Body = std::decay_t<decltype(body)>;
        if constexpr (std::is_same_v<Body, Sphere>) {
            Vector normal = on_hemisphere({0, 0, 1}, chance);
            if (chance() < Real(0.5)) normal = normal * -1;
            light.hit.normal = normal;
            light.point = to_vector(body.centre) + normal * Real{body.radius};
            light.area = 4 * pi * Real{body.radius} * Real{body.radius};
        } else if constexpr (std::is_same_v<Body, Triangle>) {
            light.area = on_triangle(body.v0, body.v1, body.v2, 1);
        } else if constexpr (std::is_same_v<Body, Quad>) {
            light.area = 2 * (chance() < Real(0.5) ? on_triangle(body.v0, body.v1, body.v2, 1)
                                                   : on_triangle(body.v0, body.v2, body.v3, 2));
        }
    });
    return light;
}

/// The radiance that a light emits at a point of it.
Vector emission_at(const SceneView& scene, std::uint32_t id, const LightPoint& light) {
    const std::uint32_t material = scene.material_of[id];
    const Vector emission = to_vector(scene.optics[material].emission);
    if (!has_textures(scene.textures)) return emission;
    const TextureUse& use = scene.textures.materials[material].emission;
    const Texel texel = sample_texture(scene, use, texture_point(scene, id, light.point, light.hit, use.slot));
    return times(emission, {texel.r, texel.g, texel.b});
}

bool is_double_sided(const SceneView& scene, std::uint32_t id) {
    bool result = false;
    visit_primitive(scene, id, [&](const auto& body) {
        if constexpr (requires { body.attributes; }) result = is_double_sided(body.attributes);
    });
    return result;
}

/// Whether the other half of a quad hides a sampled point, or coincides with it and has the lower number.
bool is_behind_other_half(const SceneView& scene, std::uint32_t id, const Vertex& vertex, const Vector& way,
                          const LightPoint& light) {
    bool behind = false;
    visit_primitive(scene, id, [&](const auto& body) {
        if constexpr (std::is_same_v<std::decay_t<decltype(body)>, Quad>) {
            const bool is_second = light.hit.corner[1] == 2;
            const FaceCorners first = {{body.v0, body.v1, body.v2}, {0, 1, 2}};
            const FaceCorners second = {{body.v0, body.v2, body.v3}, {0, 2, 3}};
            const auto other =
                hit_face(is_second ? first : second, body.attributes, scene.normals, {vertex.point, way});
            if (!other) return;
            const bool is_there = body.attributes.sides != FaceSides::culled || inner(other->facet, way) < 0;
            behind = is_there && other->t < 1 + (is_second ? rounding : -rounding);
        }
    });
    return behind;
}

/// The light of all emissive surfaces: one point of each, sampled by area. `facets`: microfacets receive it too.
Vector area_light(const BoundedView& scene, const Reflectances& material, const Vertex& vertex, bool facets,
                  Chance& chance) {
    Vector sum{0, 0, 0};
    for (std::uint32_t i = 0; i < scene.area_light_count; ++i) {
        const std::uint32_t id = scene.area_lights[i].primitive;
        if (id == vertex.primitive) continue;
        const LightPoint light = point_of_light(scene, id, chance);
        const Vector way = light.point - vertex.point;
        const Real distance2 = inner(way, way);
        const Vector l = unit(way);
        Real cosine = -inner(l, light.hit.normal);
        if (is_double_sided(scene, id)) cosine = std::abs(cosine);
        if (!(cosine > 0)) continue;
        const Vector brought = reflected(material, vertex, l, facets) * (cosine * light.area / (pi * distance2));
        if (!(largest(brought) > 0) || is_behind_other_half(scene, id, vertex, way, light)) continue;
        if (scene.area_lights_cast_shadows != 0 &&
            (!is_in_front(vertex, l) || is_blocked(scene, vertex, way, 1 - rounding, id))) {
            continue;
        }
        sum = sum + times(brought, emission_at(scene, id, light));
    }
    return sum;
}

/// The light of the background from one direction of the hemisphere. Microfacets whose reflection no path follows
/// receive the light of an environment too.
Vector sky(const BoundedView& scene, const Reflectances& material, const Vertex& vertex, const EndingLobes& ends,
           Chance& chance) {
    const Vector direction = on_hemisphere(vertex.normal, chance);
    if (scene.area_lights_cast_shadows != 0) {
        const bool shared = scene.indirect_light != 0 || material.has_facets || !material.broad.empty();
        if (has_environment(scene) && shared && !is_in_front(vertex, direction)) return {0, 0, 0};
        if (is_blocked(scene, vertex, direction, HUGE_VALL)) return {0, 0, 0};
    }
    Vector reflected{0, 0, 0};
    if (has_environment(scene) && material.has_facets && material.is_hidden) return reflected;
    if (ends.diffuse) reflected = scattered(material, direction) * inner(direction, vertex.normal);
    if (ends.facets) reflected = reflected + facets(material, vertex, direction);
    return times(reflected, background_towards(scene, direction)) * 2;
}

}  // namespace

Vector shade(const BoundedView& scene, const Vertex& vertex, const EndingLobes& ends, Chance& chance) {
    const Reflectances material = reflectances(scene, vertex);
    Vector sum = times(material.ambient, to_vector(scene.environment.ambient));
    for (std::uint32_t i = 0; i < scene.light_count; ++i) {
        const PunctualLight& light = scene.lights[i];
        Vector l{};
        const Vector intensity = light_at(light, vertex.point, l);
        const Vector brought = reflected(material, vertex, l);
        if (light.casts_shadows != 0 && largest(brought) > 0 && is_shadowed(scene, light, vertex)) continue;
        sum = sum + times(brought, intensity);
    }
    sum = sum + area_light(scene, material, vertex, ends.facets || samples_lights(material), chance);
    const bool sampled = has_environment(scene);
    const EndingLobes of_sky = {scene.indirect_light == 0 || (sampled && ends.diffuse), sampled && ends.facets};
    if (scene.environment.illuminates != 0 && (of_sky.diffuse || of_sky.facets)) {
        sum = sum + sky(scene, material, vertex, of_sky, chance);
    }
    return sum;
}

}  // namespace tandem::oracle
