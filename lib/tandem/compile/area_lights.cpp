#include "tandem/compile/area_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "tandem/compile/emissive_texture.h"

namespace tandem {

namespace {

double area_of(const Vec3f& v0, const Vec3f& v1, const Vec3f& v2) {
    const Vec3d twice = cross(widen(v1) - widen(v0), widen(v2) - widen(v0));
    return std::sqrt(dot(twice, twice)) / 2;
}
double area_of(const Sphere& sphere) { return 4 * std::numbers::pi * double{sphere.radius} * double{sphere.radius}; }
double area_of(const Triangle& face) { return area_of(face.v0, face.v1, face.v2); }
double area_of(const Quad& face) { return area_of(face.v0, face.v1, face.v2) + area_of(face.v0, face.v2, face.v3); }
template <class Body>
double area_of(const Body&) {
    return 0;
}

/// Whether one half of a quad can occlude the other. It cannot if the quad is flat, apart from the rounding of its
/// corners, and its diagonal lies within it.
bool halves_overlap(const Quad& quad) {
    const Vec3d to1 = widen(quad.v1) - widen(quad.v0);
    const Vec3d to2 = widen(quad.v2) - widen(quad.v0);
    const Vec3d to3 = widen(quad.v3) - widen(quad.v0);
    const Vec3d normal = cross(to1, to2);
    const bool is_flat = std::abs(dot(to3, normal)) <= 0x1p-20 * (norm1(to3) * norm1(normal));
    return !is_flat || !(dot(normal, cross(to2, to3)) > 0);
}
template <class Body>
bool halves_overlap(const Body&) {
    return false;
}

double brightness(const Optics& optics) {
    return double{optics.emission.x} + double{optics.emission.y} + double{optics.emission.z};
}

/// The lights share this part of the probability equally, and the rest by power: a weak light may be near and a strong
/// one hidden.
constexpr double shared_alike = 1.0 / 8;

/// Gives every light its range of the 64-bit numbers. `powers`: of each light, above 0; their sum is finite.
void share_out(std::vector<AreaLight>& lights, const std::vector<double>& powers) {
    if (lights.empty()) return;
    const double total = std::accumulate(powers.begin(), powers.end(), 0.0);
    const auto by_power = [&](double power) {
        return static_cast<std::uint64_t>(power / total * ((1 - shared_alike) * 0x1p64));
    };
    std::uint64_t rest = 0;  // 2^64 minus what is shared by power, modulo 2^64
    for (const double power : powers) rest -= by_power(power);
    const std::uint64_t count = lights.size();
    const std::uint64_t each = rest / count, left_over = rest % count;
    std::uint64_t end = 0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const std::uint64_t numbers = by_power(powers[i]) + each + (i < left_over ? 1 : 0);
        end += numbers;
        lights[i].range_last = end - 1;
        lights[i].probability = count == 1 ? 1 : static_cast<double>(numbers) * 0x1p-64;
    }
}

}  // namespace

void find_area_lights(PreparedScene& prepared) {
    const auto emits = [](const Optics& optics) { return optics.unlit == 0 && brightness(optics) > 0; };
    if (std::none_of(prepared.optics.begin(), prepared.optics.end(), emits)) return;
    const SceneView scene = view(prepared);
    EmissiveTextures textures(scene);
    std::vector<double> powers;
    for (std::uint32_t id = 0; id < primitive_count(scene); ++id) {
        const Optics& optics = scene.optics[scene.material_of[id]];
        if (!emits(optics)) continue;
        double power = 0;
        std::uint32_t kind = 0;
        bool overlaps = false;
        visit_primitive(scene, id, [&](const auto& body) {
            overlaps = halves_overlap(body);
            power = brightness(optics) * area_of(body);
            kind = kind_of<std::decay_t<decltype(body)>>;
        });
        if (power > 0) power *= textures.brightness(id);
        if (!(power > 0)) continue;
        prepared.area_light_kinds |= kind;
        powers.push_back(power);
        prepared.area_lights.push_back({0, 0, id, overlaps ? 1U : 0U});
    }
    share_out(prepared.area_lights, powers);
}

}  // namespace tandem
