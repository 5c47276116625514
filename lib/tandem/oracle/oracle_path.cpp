#include "tandem/oracle/oracle_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tandem/kernel/media/medium_stack.h"  // for no_medium alone
#include "tandem/oracle/oracle_environment.h"
#include "tandem/oracle/oracle_textures.h"

namespace tandem::oracle {

namespace {

Real largest(const Vector& a) { return std::max({a.x, a.y, a.z}); }

/// A point of a surface that a path has reached.
struct Vertex {
    Vector point;
    Vector direction;  ///< of the path, unit
    Vector facet;      ///< the surface's own normal, outward
    Vector normal;     ///< for shading, as the scene says it
    Texel picture{1, 1, 1, 1};
    std::uint32_t primitive = no_primitive;
    std::uint32_t material = 0;
    bool from_inside = false;
    bool shines = false;  ///< this side emits, if the surface is emissive
    bool is_hole = false;
    Vector emission{0, 0, 0};
    Real roughness = 0, metal = 0;  ///< of microfacets
};

Vertex vertex_at(const SceneView& scene, const Line& ray, const NearestSurface& nearest) {
    Vertex vertex{};
    vertex.point = ray.origin + ray.direction * nearest.surface.t;
    vertex.direction = unit(ray.direction);
    vertex.facet = nearest.surface.facet;
    vertex.normal = nearest.surface.normal;
    vertex.primitive = nearest.primitive;
    vertex.material = scene.material_of[nearest.primitive];
    vertex.from_inside = inner(vertex.direction, vertex.facet) > 0;
    const bool double_sided = nearest.surface.sides == FaceSides::double_sided;
    const Optics& optics = scene.optics[vertex.material];
    vertex.shines = !vertex.from_inside || double_sided || optics.unlit != 0;
    vertex.emission = to_vector(optics.emission);
    if (scene.microfacet_count > 0) {
        vertex.roughness = scene.microfacets[vertex.material].roughness;
        vertex.metal = scene.microfacets[vertex.material].metallic;
    }
    if (!has_textures(scene.textures)) return vertex;
    const MaterialTextures& textures = scene.textures.materials[vertex.material];
    const auto at = [&](std::uint32_t slot) {
        return texture_point(scene, nearest.primitive, vertex.point, nearest.surface, slot);
    };
    vertex.picture = base_colour_at(scene, nearest.primitive, vertex.point, nearest.surface);
    vertex.is_hole = product_of_alphas(textures.alpha, vertex.picture.a) < Real{textures.alpha_cutoff};
    const Texel facets = sample_texture(scene, textures.metallic_roughness, at(textures.metallic_roughness.slot));
    vertex.roughness *= facets.g;
    vertex.metal *= facets.b;
    const Texel glow =
        optics.unlit != 0 ? vertex.picture : sample_texture(scene, textures.emission, at(textures.emission.slot));
    vertex.emission = times(vertex.emission, {glow.r, glow.g, glow.b});
    if (textures.normal.texture != no_texture) {
        const TexturePoint point = at(textures.normal.slot);
        const Texel texel = sample_texture(scene, textures.normal, point);
        const bool turned = double_sided && vertex.from_inside;
        const Vector n = vertex.normal * (turned ? -1 : 1);
        const Vector t = unit(point.along_u - n * inner(point.along_u, n));
        Vector b = {n.y * t.z - n.z * t.y, n.z * t.x - n.x * t.z, n.x * t.y - n.y * t.x};
        if (inner(b, point.along_v) > 0) b = b * -1;
        const Real scale = textures.normal_scale;
        const Vector bent =
            unit(t * ((2 * texel.r - 1) * scale) + b * ((2 * texel.g - 1) * scale) + n * (2 * texel.b - 1));
        vertex.normal = bent * (turned ? -1 : 1);
    }
    return vertex;
}

/// What lies within this of the end of a way, relative to its length, lies at the end.
constexpr Real rounding = 0x1p-45L;

/// Does anything but holes and `except` stand on the way from `vertex`, up to `to` times `way`?
bool is_stopped(const SceneView& scene, const Vertex& vertex, const Vector& way, Real to,
                std::uint32_t except = no_primitive) {
    const Line ray = {vertex.point, way};
    const RaySource source = {vertex.primitive, inner(way, vertex.facet) < 0};
    Passed passed;
    while (true) {
        const NearestSurface between = nearest_surface(scene, ray, source, except, &passed);
        if (between.primitive == no_primitive || between.surface.t >= to) return false;
        if (!vertex_at(scene, ray, between).is_hole) return true;
        passed = {between.surface.t, between.primitive};
    }
}

/// Is a light in the direction l on the side of the surface that is looked at, and before the normal for shading?
bool is_in_front(const Vertex& vertex, const Vector& l) {
    const Real side = vertex.from_inside ? -1 : 1;
    return inner(l, vertex.facet) * side > 0 && inner(l, vertex.normal) > 0;
}

/// Numbers of its own in [0, 1), for what it estimates otherwise than the backends.
class Chance {
  public:
    Chance(const SampleId<float>& sample, std::uint32_t vertex) : sample_(sample), vertex_(vertex) {}
    Real operator()() {
        if (next_ % 4 == 0) block_ = sample_.block(static_cast<Dimension>(128 + next_ / 4), vertex_);
        return Real{to_unit_interval<float>(block_.word[next_++ % 4])};
    }

  private:
    SampleId<float> sample_;
    std::uint32_t vertex_;
    std::uint32_t next_ = 0;
    PhiloxBlock<std::uint32_t> block_{};
};

constexpr Real pi = std::numbers::pi_v<Real>;

/// Uniform on the hemisphere around n.
Vector on_hemisphere(const Vector& n, Chance& chance) {
    const Real z = 2 * chance() - 1, angle = 2 * pi * chance();
    const Real r = std::sqrt(std::max<Real>(0, 1 - z * z));
    const Vector d = {r * std::cos(angle), r * std::sin(angle), z};
    return inner(d, n) < 0 ? d * -1 : d;
}

bool is_shadowed(const SceneView& scene, const PunctualLight& light, const Vertex& vertex) {
    const bool directional = light.kind == PunctualKind::directional;
    const Vector to_light = directional ? to_vector(light.direction) * -1 : to_vector(light.position) - vertex.point;
    if (!is_in_front(vertex, to_light)) return true;  // behind the surface itself, or at the very point
    return is_stopped(scene, vertex, to_light, directional ? HUGE_VALL : 1 - rounding);
}

/// What a light brings to a point, without regard to shadows, and the unit direction to it.
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
        const Vector chord = to_light + axis;  // from the axis to the light's way to the point; 2 - 2 cos is its square
        const Real share = (Real{light.cone_height} - inner(chord, chord) / 2) * Real{light.cone_scale};
        intensity = intensity * std::pow(std::clamp<Real>(share, 0, 1), 2);
    }
    if (light.inverse_square != 0) intensity = intensity * (1 / inner(offset, offset));
    return intensity;
}

/// Phong's reflectances where a path has met a surface; or those of microfacets, without a specular one.
struct Reflectances {
    Vector ambient, diffuse, specular;
    Real shininess;
    bool has_facets = false;
    Vector f0{0, 0, 0};  ///< of microfacets: reflectance head-on
    Real border = 0;     ///< the same of what covers the diffuse base
    Real alpha = 0;      ///< of GGX
    Vector to_viewer{};  ///< on the side of the normal for shading
};

bool is_of_facets(const SceneView& scene, const Vertex& vertex) {
    return scene.microfacet_count > 0 && scene.microfacets[vertex.material].is_there != 0;
}

Vector colour_of(const Vertex& vertex) { return {vertex.picture.r, vertex.picture.g, vertex.picture.b}; }

/// Of microfacets, whichever side is seen.
Reflectances facets_at(const SceneView& scene, const Vertex& vertex) {
    const PhongMaterial& material = scene.materials[vertex.material];
    const Vector base = times(to_vector(material.diffuse), colour_of(vertex));
    const Real dielectric = 1 - vertex.metal;
    Reflectances facets{
        times(to_vector(material.ambient), colour_of(vertex)) * dielectric, base * dielectric, {0, 0, 0}, 1};
    const Real ior = scene.optics[vertex.material].ior;
    facets.border = std::pow((1 - ior) / (1 + ior), 2);
    facets.f0 = base * vertex.metal + Vector{1, 1, 1} * (facets.border * dielectric);
    facets.alpha = std::clamp<Real>(vertex.roughness * vertex.roughness, Real(0x1p-13), 1);
    return facets;
}

Reflectances reflectances(const SceneView& scene, const Vertex& vertex) {
    const PhongMaterial& material = scene.materials[vertex.material];
    const Real transmission = scene.optics[vertex.material].transmission;
    const Vector colour = colour_of(vertex);
    if (is_of_facets(scene, vertex)) {
        Reflectances facets = facets_at(scene, vertex);
        facets.to_viewer = vertex.direction * -1;
        const Real height = inner(facets.to_viewer, vertex.normal);
        facets.has_facets = height > 0 || !vertex.from_inside;
        if (height < 0) facets.to_viewer = facets.to_viewer - vertex.normal * (2 * height);
        if (!facets.has_facets) facets.diffuse = {0, 0, 0};
        return facets;
    }
    const Real highlight = transmission > 0 && vertex.from_inside ? 0 : 1;
    return {times(to_vector(material.ambient), colour) * (1 - transmission),
            times(to_vector(material.diffuse), colour) * (1 - transmission), to_vector(material.specular) * highlight,
            Real{material.shininess}};
}

/// Schlick's way from the reflectance head-on to 1, for the microfacets that mirror l to the viewer.
Real grazing(const Reflectances& material, const Vector& l) {
    return std::pow(std::max<Real>(0, 1 - inner(unit(l + material.to_viewer), l)), 5);
}

/// Smith's Lambda of GGX: facets that are hidden for each that is seen, from a direction with this cosine.
Real hidden(Real alpha, Real cosine) {
    const Real tangent = std::sqrt(std::max<Real>(0, (1 - cosine) * (1 + cosine))) / cosine;
    return (std::hypot(Real(1), alpha * tangent) - 1) / 2;
}

/// GGX by angles, as Walter and others write it; times pi and the cosine of the light.
Vector facets(const Reflectances& material, const Vertex& vertex, const Vector& l) {
    const Vector n = vertex.normal, v = material.to_viewer;
    const Real to_light = inner(n, l), to_viewer = inner(n, v);
    if (!material.has_facets || !(to_light > 0) || !(to_viewer > 0)) return {0, 0, 0};
    const Real a2 = material.alpha * material.alpha;
    const Real cosine = std::min<Real>(1, inner(n, unit(l + v)));
    const Vector sine = unit(l + v) - n * cosine;
    const Real tangent2 = inner(sine, sine) / (cosine * cosine);
    const Real density = a2 / (pi * std::pow(cosine, 4) * std::pow(a2 + tangent2, 2));
    const Real seen = 1 / (1 + hidden(material.alpha, to_light) + hidden(material.alpha, to_viewer));
    const Vector f = material.f0 + (Vector{1, 1, 1} - material.f0) * grazing(material, l);
    return f * (pi * density * seen / (4 * to_viewer));
}

/// The share of light from l that comes to the diffuse base and back to the viewer.
Real uncovered(const Reflectances& material, const Vector& l) {
    return material.has_facets ? (1 - material.border) * (1 - grazing(material, l)) : 1;
}

/// Do lights with an area bring light to microfacets by points that are drawn on them? Else paths find them.
bool draws_lights(const Reflectances& material) { return material.alpha > Real(0.3); }

/// Light of unit intensity from the direction l: after the paper's formula, or from microfacets if these are `seen`.
Vector reflected(const Reflectances& material, const Vertex& vertex, const Vector& l, bool seen = true) {
    const Vector n = vertex.normal;
    if (material.has_facets) {
        const Vector base = material.diffuse * (std::max<Real>(0, inner(l, n)) * uncovered(material, l));
        return seen ? base + facets(material, vertex, l) : base;
    }
    const Vector r = n * (2 * inner(l, n)) - l;
    const Real mirror = -inner(r, vertex.direction);
    const Real specular = mirror > 0 ? std::pow(std::min<Real>(1, mirror), material.shininess) : 0;
    return material.diffuse * std::max<Real>(0, inner(l, n)) + material.specular * specular;
}

/// A point of an emissive surface.
struct LightPoint {
    Vector point;
    SurfaceHit hit;  ///< normal, corners and weights there
    Real area = 0;   ///< of the surface
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

/// What leaves a light at a point of it.
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

/// Does the other half of a quad stand before the point that was drawn on one, or lie upon it with the lower number?
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

/// From all emissive surfaces: a point of each, by area. `facets`: also to microfacets.
Vector glow(const SceneView& scene, const Reflectances& material, const Vertex& vertex, bool facets, Chance& chance) {
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
            (!is_in_front(vertex, l) || is_stopped(scene, vertex, way, 1 - rounding, id))) {
            continue;
        }
        sum = sum + times(brought, emission_at(scene, id, light));
    }
    return sum;
}

/// Which lobes of a vertex reflect what no path will find.
struct EndingLobes {
    bool diffuse, facets;
};

/// From the background, in one direction of the hemisphere. Facets that no path follows show a picture as well.
Vector sky(const SceneView& scene, const Reflectances& material, const Vertex& vertex, const EndingLobes& ends,
           Chance& chance) {
    const Vector direction = on_hemisphere(vertex.normal, chance);
    if (scene.area_lights_cast_shadows != 0) {
        const bool shared = scene.environment.indirect != 0 || material.has_facets;
        if (has_picture(scene) && shared && !is_in_front(vertex, direction)) return {0, 0, 0};
        if (is_stopped(scene, vertex, direction, HUGE_VALL)) return {0, 0, 0};
    }
    Vector reflected{0, 0, 0};
    if (ends.diffuse) reflected = material.diffuse * (inner(direction, vertex.normal) * uncovered(material, direction));
    if (ends.facets) reflected = reflected + facets(material, vertex, direction);
    return times(reflected, background_towards(scene, direction)) * 2;
}

/// All that a surface reflects of what gives light.
Vector shade(const SceneView& scene, const Vertex& vertex, const EndingLobes& ends, Chance& chance) {
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
    sum = sum + glow(scene, material, vertex, ends.facets || draws_lights(material), chance);
    const bool picture = has_picture(scene);
    const EndingLobes of_sky = {scene.environment.indirect == 0 || (picture && ends.diffuse), picture && ends.facets};
    if (scene.environment.illuminates != 0 && (of_sky.diffuse || of_sky.facets)) {
        sum = sum + sky(scene, material, vertex, of_sky, chance);
    }
    return sum;
}

/// The media that a path is in, by material, in the order of entering.
class Media {
  public:
    explicit Media(const SceneView& scene) : optics_(scene.optics) {
        inside_.assign(scene.camera_media.material, scene.camera_media.material + scene.camera_media.count);
    }
    [[nodiscard]] std::uint32_t current() const {
        std::uint32_t best = no_medium;
        for (const std::uint32_t medium : inside_) {
            if (best == no_medium || priority(medium) >= priority(best)) best = medium;
        }
        return best;
    }
    void cross(std::uint32_t material, bool from_inside) {
        if (!from_inside) {
            if (inside_.size() < 8) inside_.push_back(material);
            return;
        }
        const auto last = std::find(inside_.rbegin(), inside_.rend(), material);
        if (last != inside_.rend()) inside_.erase(std::next(last).base());
    }

  private:
    [[nodiscard]] std::uint32_t priority(std::uint32_t medium) const { return optics_[medium].priority; }
    const Optics* optics_;
    std::vector<std::uint32_t> inside_;
};

Real index_of(const SceneView& scene, std::uint32_t medium) {
    return medium == no_medium ? 1 : Real{scene.optics[medium].ior};
}

/// Snell and Fresnel, by angles. Returns the reflectance; 1 for total reflection.
Real refract(const Vector& d, const Vector& n, Real from, Real to, Vector& onward) {
    const Real eta = from / to;
    if (eta == 1) {
        onward = d;
        return 0;
    }
    const Real cos_in = std::clamp<Real>(-inner(d, n), 0, 1);
    const Vector tangent = d + n * cos_in;
    const Real sin_out = std::sqrt(inner(tangent, tangent)) * eta;
    if (sin_out > 1) return 1;
    const Real cos_out = std::sqrt((1 - sin_out) * (1 + sin_out));
    onward = unit(tangent * eta - n * cos_out);
    const Real s = (from * cos_in - to * cos_out) / (from * cos_in + to * cos_out);
    const Real p = (from * cos_out - to * cos_in) / (from * cos_out + to * cos_in);
    return (s * s + p * p) / 2;
}

/// How far a point is before the plane through the camera that it looks away from.
float depth_of(const CameraView& camera, const Vector& point) {
    const Vector right = to_vector(camera.orthographic ? camera.origin_dx : camera.direction_dx);
    const Vector down = to_vector(camera.orthographic ? camera.origin_dy : camera.direction_dy);
    const Vector axis = {down.y * right.z - down.z * right.y, down.z * right.x - down.x * right.z,
                         down.x * right.y - down.y * right.x};
    return static_cast<float>(std::abs(inner(point - to_vector(camera.origin), unit(axis))));
}

/// All that a surface reflects and transmits.
Vector albedo_of(const SceneView& scene, const Vertex& vertex) {
    const Optics& optics = scene.optics[vertex.material];
    const Real t = optics.transmission;
    const bool facets = is_of_facets(scene, vertex);
    const Reflectances material = facets ? facets_at(scene, vertex) : reflectances(scene, vertex);
    const Vector diffuse = material.diffuse * (facets ? 1 - t : Real(1));
    const Vector specular = facets ? material.f0 : to_vector(scene.materials[vertex.material].specular);
    const Vector sum = diffuse + specular + to_vector(optics.mirror) + Vector{t, t, t};
    return {std::min<Real>(sum.x, 1), std::min<Real>(sum.y, 1), std::min<Real>(sum.z, 1)};
}

Vector mirrored(const Vector& d, const Vector& n) { return unit(d - n * (2 * inner(d, n))); }

/// Mirrors the path at a normal of GGX, drawn with the density D cos; returns what it carries on, none if it ends.
Vector reflect_at_facet(const Reflectances& material, const Vertex& vertex, Vector& onward, Chance& chance) {
    const Vector n = vertex.normal, v = material.to_viewer;
    const Vector side = std::abs(n.x) < Real(0.5) ? Vector{1, 0, 0} : Vector{0, 1, 0};
    const Vector t = unit(side - n * inner(side, n));
    const Vector b = {n.y * t.z - n.z * t.y, n.z * t.x - n.x * t.z, n.x * t.y - n.y * t.x};
    const Real u = chance(), angle = 2 * pi * chance();
    const Real tangent = material.alpha * std::sqrt(u / (1 - u));
    const Vector h = unit(t * (tangent * std::cos(angle)) + b * (tangent * std::sin(angle)) + n);
    onward = unit(h * (2 * inner(v, h)) - v);
    const Real to_light = inner(n, onward), to_viewer = inner(n, v);
    if (!(inner(v, h) > 0) || !(to_light > 0) || !(to_viewer > 0)) return {0, 0, 0};
    const Vector f = material.f0 + (Vector{1, 1, 1} - material.f0) * grazing(material, onward);
    const Real seen = 1 / (1 + hidden(material.alpha, to_light) + hidden(material.alpha, to_viewer));
    return f * (seen * inner(v, h) / (to_viewer * inner(n, h)));
}

}  // namespace

NearestSurface nearest_surface(const SceneView& scene, const Line& line, const RaySource& source, std::uint32_t except,
                               const Passed* passed) {
    NearestSurface nearest;
    for (std::uint32_t id = 0; id < primitive_count(scene); ++id) {
        if (id == except) continue;
        const auto counts = [&](const SurfaceHit& hit) {
            if (passed == nullptr) return true;
            if (hit.sides == FaceSides::culled && inner(line.direction, hit.facet) > 0) return false;
            return hit.t > passed->t || (hit.t == passed->t && id > passed->primitive);
        };
        const Start start = id != source.primitive ? Start::anywhere
                            : source.inside        ? Start::leaving_inward
                                                   : Start::leaving_outward;
        auto hit = hit_primitive(scene, id, line, start);
        // what it has met before it may cross once more: a body, or a folded quad
        if (hit && !counts(*hit) && start == Start::anywhere) hit = hit_primitive(scene, id, line, Start::before_first);
        if (hit && !counts(*hit)) continue;
        // ids ascend, so a tie keeps the lower one
        if (hit && (nearest.primitive == no_primitive || hit->t < nearest.surface.t)) nearest = {*hit, id};
    }
    return nearest;
}

void add_first_hit(const SceneView& scene, const CameraView& camera, const Line& camera_ray, bool is_first,
                   std::size_t pixel, const FilmPlanes& planes) {
    Passed passed;
    NearestSurface nearest;
    Vertex vertex{};
    do {
        nearest = nearest_surface(scene, camera_ray, {}, no_primitive, &passed);
        if (nearest.primitive != no_primitive) vertex = vertex_at(scene, camera_ray, nearest);
        passed = {nearest.surface.t, nearest.primitive};
    } while (nearest.primitive != no_primitive && vertex.is_hole);
    const bool hits = nearest.primitive != no_primitive;
    if (is_first && planes.depth != nullptr) planes.depth[pixel] = hits ? depth_of(camera, vertex.point) : HUGE_VALF;
    if (is_first && planes.primitive != nullptr) planes.primitive[pixel] = nearest.primitive;
    if (is_first && planes.material != nullptr) planes.material[pixel] = hits ? vertex.material : no_primitive;
    if (!hits) return;
    const auto add = [pixel](const Vector& value, Vec3d* plane) {
        if (plane == nullptr) return;
        plane[pixel] += Vec3d{static_cast<double>(value.x), static_cast<double>(value.y), static_cast<double>(value.z)};
    };
    add(albedo_of(scene, vertex), planes.albedo);
    add(vertex.normal, planes.normal);
}

Vector trace_path(const SceneView& scene, const PathLimits& limits, const SampleId<float>& sample,
                  const Line& camera_ray) {
    Line ray = camera_ray;
    RaySource source;
    Passed passed;
    Vector radiance{0, 0, 0}, throughput{1, 1, 1};
    Media media(scene);
    std::uint32_t reflections = 0, refractions = 0, scatterings = 0;
    bool was_scattered = false;  // by a diffuse surface, at the vertex before
    bool was_drawn = false;      // then, or by microfacets, what lights with an area bring
    for (std::uint32_t vertex_number = 0;; ++vertex_number) {
        const NearestSurface nearest = nearest_surface(scene, ray, source, no_primitive, &passed);
        if (nearest.primitive == no_primitive) {
            const bool shows = !was_scattered || scene.environment.illuminates != 0;
            const Vector seen = background_towards(scene, ray.direction);
            return shows ? radiance + times(throughput, seen) : radiance;
        }
        const Vertex vertex = vertex_at(scene, ray, nearest);
        const Optics& optics = scene.optics[vertex.material];
        const bool is_glass = optics.transmission > 0;

        const std::uint32_t own = is_glass && vertex.from_inside ? vertex.material : no_medium;
        const std::uint32_t medium = scene.media_overlap != 0 ? media.current() : own;
        if (medium != no_medium) {
            const Vector a = to_vector(scene.optics[medium].absorption);
            const Real distance = (nearest.surface.t - passed.t) * std::sqrt(inner(ray.direction, ray.direction));
            throughput =
                times(throughput, {std::exp(-a.x * distance), std::exp(-a.y * distance), std::exp(-a.z * distance)});
        }
        if (vertex.is_hole) {
            passed = {nearest.surface.t, nearest.primitive};
            continue;
        }
        // what is drawn from lights at one vertex is not found again at the next
        const bool is_drawn =
            was_drawn && std::any_of(scene.area_lights, scene.area_lights + scene.area_light_count,
                                     [&](const AreaLight& light) { return light.primitive == vertex.primitive; });
        const bool is_dark = is_drawn || (optics.unlit != 0 && was_scattered);  // what is unlit lights nothing
        if (vertex.shines && !is_dark) radiance = radiance + times(throughput, vertex.emission);
        Chance chance(sample, vertex_number);
        const bool is_front = !(inner(vertex.direction, vertex.normal) > 0);
        const EndingLobes ends = {!is_front || scatterings >= limits.diffuse, reflections >= limits.reflection};
        radiance = radiance + times(throughput, shade(scene, vertex, ends, chance));

        const Reflectances material = reflectances(scene, vertex);
        const Vector diffuse = material.diffuse;
        const Real mirror = largest(to_vector(optics.mirror)), glass = optics.transmission;
        const Real matt = scene.environment.indirect != 0 && is_front ? largest(diffuse) : 0;
        const Real glossy = material.has_facets ? std::max<Real>(largest(material.f0), Real(0.1)) : 0;
        if (!(mirror > 0) && !is_glass && !(matt > 0) && !(glossy > 0)) return radiance;
        const auto random = sample.block(Dimension::scatter, vertex_number);
        const Real total = mirror + glass + matt + glossy;
        const Real place = Real{to_unit_interval<float>(random.word[0])} * total;
        const bool takes_mirror = mirror > 0 && (place < mirror || (!is_glass && !(matt > 0)));
        const bool takes_glass = !takes_mirror && is_glass && (place < mirror + glass || !(matt > 0));
        const bool takes_glossy = glossy > 0 && (place < glossy || !(matt > 0));
        const Vector facing = vertex.facet * (vertex.from_inside ? -1 : 1);
        const Vector normal = vertex.normal * (is_front ? 1 : -1);
        bool through = false;
        was_scattered = !takes_mirror && !takes_glass && !takes_glossy;
        was_drawn = was_scattered || (takes_glossy && draws_lights(material));
        Vector onward{};
        if (takes_glass) {
            Media behind = media;
            behind.cross(vertex.material, vertex.from_inside);
            const std::uint32_t other = is_glass && !vertex.from_inside ? vertex.material : no_medium;
            const Real from = index_of(scene, medium);
            const Real to = index_of(scene, scene.media_overlap != 0 ? behind.current() : other);
            Real reflectance = refract(vertex.direction, normal, from, to, onward);
            if (reflectance < 1 && !(inner(onward, facing) < 0)) {
                reflectance = refract(vertex.direction, facing, from, to, onward);
            }
            through = reflectance < 1 && !(to_unit_interval<float>(random.word[1]) < reflectance);
            if (through) media = behind;
            throughput = throughput * total;
        } else if (takes_glossy) {
            throughput = times(throughput, reflect_at_facet(material, vertex, onward, chance) * (total / glossy));
            if (!(inner(onward, facing) > 0) || !(largest(throughput) > 0)) return radiance;
        } else if (takes_mirror) {
            throughput = times(throughput, to_vector(optics.mirror) * (total / mirror));
        } else {
            onward = on_hemisphere(normal, chance);
            if (!(inner(onward, facing) > 0)) return radiance;
            throughput =
                times(throughput, diffuse * (2 * inner(onward, normal) * uncovered(material, onward) * total / matt));
        }
        if (!through && !was_scattered && !takes_glossy) {
            onward = mirrored(vertex.direction, normal);
            if (!(inner(onward, facing) > 0)) onward = mirrored(vertex.direction, facing);
        }
        (was_scattered ? scatterings : through ? refractions : reflections) += 1;
        if (reflections > limits.reflection || refractions > limits.refraction || scatterings > limits.diffuse) {
            return radiance;
        }
        ray = {vertex.point, onward};
        source = {vertex.primitive, through ? !vertex.from_inside : vertex.from_inside};
        passed = {};
    }
}

}  // namespace tandem::oracle
