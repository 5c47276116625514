#include "tandem/scene/area_lights.h"

#include <cmath>
#include <numbers>

#include "tandem/scene/emissive_texture.h"

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

}  // namespace

void find_area_lights(PreparedScene& prepared) {
    const SceneView scene = view(prepared);
    EmissiveTextures textures(scene);
    std::vector<double> powers;
    double total = 0;
    for (std::uint32_t id = 0; id < primitive_count(scene); ++id) {
        const Optics& optics = scene.optics[scene.material_of[id]];
        if (optics.unlit != 0) continue;
        const Vec3f& emission = optics.emission;
        const double brightness = double{emission.x} + double{emission.y} + double{emission.z};
        if (!(brightness > 0)) continue;
        double power = 0;
        std::uint32_t kind = 0;
        visit_primitive(scene, id, [&](const auto& body) {
            power = brightness * area_of(body);
            kind = kind_of<std::decay_t<decltype(body)>>;
        });
        if (power > 0) power *= textures.brightness(id);
        if (!(power > 0)) continue;
        prepared.area_light_kinds |= kind;
        total += power;
        powers.push_back(power);
        prepared.area_lights.push_back({id, 0, 0});
    }
    // The chances are the steps between the sums that are compared, as rounding has left them.
    double sum = 0;
    float before = 0;
    for (std::size_t i = 0; i < powers.size(); ++i) {
        sum += powers[i];
        AreaLight& light = prepared.area_lights[i];
        light.chance_upto = static_cast<float>(sum / total);
        light.chance = light.chance_upto - before;
        before = light.chance_upto;
    }
}

}  // namespace tandem
