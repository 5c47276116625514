#include "tandem/oracle/oracle_path.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tandem/material/medium_stack.h"  // for no_medium alone

namespace tandem::oracle {

namespace {

Vector background_towards(const Environment& environment, const Vector& direction) {
    const Real m = (unit(direction).y + 1) / 2;
    return to_vector(environment.bottom) * (1 - m) + to_vector(environment.top) * m;
}

/// A point of a surface that a path has reached.
struct Vertex {
    Vector point;
    Vector direction;  ///< of the path, unit
    Vector facet;      ///< the surface's own normal, outward
    Vector normal;     ///< for shading, as the scene says it
    std::uint32_t primitive;
    std::uint32_t material;
    bool from_inside;
};

bool is_shadowed(const SceneView& scene, const PunctualLight& light, const Vertex& vertex) {
    const bool directional = light.kind == PunctualKind::directional;
    const Vector to_light = directional ? to_vector(light.direction) * -1 : to_vector(light.position) - vertex.point;
    if (inner(to_light, to_light) == 0) return true;  // at the very light
    const RaySource source = {vertex.primitive, inner(to_light, vertex.facet) < 0};
    const NearestSurface between = nearest_surface(scene, {vertex.point, to_light}, source);
    return between.primitive != no_primitive && (directional || between.surface.t < 1);
}

/// What a light brings to a point, without regard to shadows, and the unit direction to it.
Vector light_at(const PunctualLight& light, const Vector& point, Vector& to_light) {
    Vector intensity = to_vector(light.intensity);
    if (light.kind == PunctualKind::directional) {
        to_light = to_vector(light.direction) * -1;
        return intensity;
    }
    const Vector offset = to_vector(light.position) - point;
    to_light = unit(offset);
    if (light.kind == PunctualKind::spot) {
        const Real cosine = -inner(to_light, to_vector(light.direction));
        const Real share = (cosine - Real{light.cos_outer}) * Real{light.cone_scale};
        intensity = intensity * std::pow(std::clamp<Real>(share, 0, 1), 2);
    }
    if (light.inverse_square != 0) intensity = intensity * (1 / inner(offset, offset));
    return intensity;
}

/// Phong's sum, written out once more from the paper's formula.
Vector shade(const SceneView& scene, const Vertex& vertex) {
    const PhongMaterial& material = scene.materials[vertex.material];
    const Real transmission = scene.optics[vertex.material].transmission;
    const Vector ambient = to_vector(material.ambient) * (1 - transmission);
    const Vector diffuse_part = to_vector(material.diffuse) * (1 - transmission);
    const Real highlight = transmission > 0 && vertex.from_inside ? 0 : 1;
    const Vector n = vertex.normal;
    const Vector v = vertex.direction * -1;
    Vector sum = times(ambient, to_vector(scene.environment.ambient));
    for (std::uint32_t i = 0; i < scene.light_count; ++i) {
        const PunctualLight& light = scene.lights[i];
        Vector l{};
        const Vector intensity = light_at(light, vertex.point, l);
        const Vector r = n * (2 * inner(l, n)) - l;
        const Real diffuse = std::max<Real>(0, inner(l, n));
        const Real mirror = inner(r, v);
        const Real specular = mirror > 0 ? std::pow(std::min<Real>(1, mirror), Real{material.shininess}) : 0;
        if (light.casts_shadows != 0 && (diffuse > 0 || specular > 0) && is_shadowed(scene, light, vertex)) continue;
        sum = sum + times(diffuse_part * diffuse + to_vector(material.specular) * (specular * highlight), intensity);
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

Vector mirrored(const Vector& d, const Vector& n) { return unit(d - n * (2 * inner(d, n))); }

Real largest(const Vector& a) { return std::max({a.x, a.y, a.z}); }

}  // namespace

NearestSurface nearest_surface(const SceneView& scene, const Line& line, const RaySource& source,
                               std::uint32_t except) {
    NearestSurface nearest;
    for (std::uint32_t id = 0; id < primitive_count(scene); ++id) {
        if (id == except) continue;
        const Start start = id != source.primitive ? Start::anywhere
                            : source.inside        ? Start::leaving_inward
                                                   : Start::leaving_outward;
        const auto hit = hit_primitive(scene, id, line, start);
        // ids ascend, so a tie keeps the lower one
        if (hit && (nearest.primitive == no_primitive || hit->t < nearest.surface.t)) nearest = {*hit, id};
    }
    return nearest;
}

Vector trace_path(const SceneView& scene, const PathLimits& limits, const SampleId<float>& sample,
                  const Line& camera_ray) {
    Line ray = camera_ray;
    RaySource source;
    Vector radiance{0, 0, 0}, throughput{1, 1, 1};
    Media media(scene);
    std::uint32_t reflections = 0, refractions = 0;
    for (std::uint32_t vertex_number = 0;; ++vertex_number) {
        const NearestSurface nearest = nearest_surface(scene, ray, source);
        if (nearest.primitive == no_primitive) {
            return radiance + times(throughput, background_towards(scene.environment, ray.direction));
        }
        Vertex vertex{};
        vertex.point = ray.origin + ray.direction * nearest.surface.t;
        vertex.direction = unit(ray.direction);
        vertex.facet = nearest.surface.facet;
        vertex.normal = nearest.surface.normal;
        vertex.primitive = nearest.primitive;
        vertex.material = scene.material_of[nearest.primitive];
        vertex.from_inside = inner(vertex.direction, vertex.facet) > 0;
        const Optics& optics = scene.optics[vertex.material];
        const bool is_glass = optics.transmission > 0;

        const std::uint32_t own = is_glass && vertex.from_inside ? vertex.material : no_medium;
        const std::uint32_t medium = scene.media_overlap != 0 ? media.current() : own;
        if (medium != no_medium) {
            const Vector a = to_vector(scene.optics[medium].absorption);
            const Vector way = vertex.point - ray.origin;
            const Real distance = std::sqrt(inner(way, way));
            throughput =
                times(throughput, {std::exp(-a.x * distance), std::exp(-a.y * distance), std::exp(-a.z * distance)});
        }
        radiance = radiance + times(throughput, shade(scene, vertex));

        const Real mirror = largest(to_vector(optics.mirror)), glass = optics.transmission;
        if (!(mirror > 0) && !is_glass) return radiance;
        const auto random = sample.block(Dimension::scatter, vertex_number);
        const Real total = mirror + glass;
        const bool takes_glass = is_glass && !(mirror > 0 && to_unit_interval<float>(random.word[0]) * total < mirror);
        const Vector facing = vertex.facet * (vertex.from_inside ? -1 : 1);
        const Vector normal = vertex.normal * (inner(vertex.direction, vertex.normal) > 0 ? -1 : 1);
        bool through = false;
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
            throughput = throughput * (mirror > 0 ? total : glass);
        } else {
            throughput = times(throughput, to_vector(optics.mirror) * (is_glass ? total / mirror : 1));
        }
        if (!through) {
            onward = mirrored(vertex.direction, normal);
            if (!(inner(onward, facing) > 0)) onward = mirrored(vertex.direction, facing);
        }
        (through ? refractions : reflections) += 1;
        if (reflections > limits.reflection || refractions > limits.refraction) return radiance;
        ray = {vertex.point, onward};
        source = {vertex.primitive, through ? !vertex.from_inside : vertex.from_inside};
    }
}

}  // namespace tandem::oracle
