#include "tandem/gltf/lights.h"

#include <fmt/format.h>

#include <numbers>

#include "tandem/gltf/materials.h"

namespace tandem::gltf {

namespace {

std::optional<LightKind> kind_of(const std::string& type) {
    if (type == "point") return LightKind::point;
    if (type == "spot") return LightKind::spot;
    if (type == "directional") return LightKind::directional;
    return std::nullopt;
}

void read_cone(const Document& document, const Json& light, const std::string& path, LightSource& source) {
    const Json* spot = find(light, "spot");
    if (spot == nullptr) document.fail(path, "is a spot light without the property 'spot'");
    source.inner_cone = spot->value("innerConeAngle", 0.0);
    source.outer_cone = spot->value("outerConeAngle", std::numbers::pi / 4);
    if (!(source.inner_cone < source.outer_cone)) {
        document.fail(path, "is a spot light whose innerConeAngle is not below its outerConeAngle");
    }
}

}  // namespace

std::optional<LightSource> read_light(const Document& document, const Json& light, const std::string& path,
                                      ImportReport& report) {
    const auto type = light["type"].get<std::string>();
    const std::string feature = fmt::format("KHR_lights_punctual {}", type);
    const std::optional<LightKind> kind = kind_of(type);
    if (!kind) {
        report.add(Treatment::ignored, feature, path, "the types are point, spot and directional");
        return std::nullopt;
    }
    LightSource source;
    source.kind = *kind;
    source.colour = read_colour(light, "color", {1, 1, 1});
    source.intensity = light.value("intensity", 1.0F);
    if (source.kind == LightKind::spot) read_cone(document, light, path, source);
    const Json* phong = find_extension(light, "TANDEM_lights_phong");
    const bool falls_off = phong == nullptr || phong->value("falloff", true);
    source.casts_shadows = phong == nullptr || phong->value("shadows", true);
    source.inverse_square = falls_off && source.kind != LightKind::directional;
    // what Phong's model takes for a surface to be as bright as a Lambertian one under that illuminance
    if (falls_off) source.intensity = static_cast<float>(source.intensity / std::numbers::pi);
    report.add(Treatment::rendered, feature, path,
               falls_off ? "in candela, or lux from one direction" : "Phong's model takes colour times intensity");
    return source;
}

}  // namespace tandem::gltf
