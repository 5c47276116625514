#include "tandem/gltf/lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
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

void read_cone(const Json& light, const std::string& path, LightSource& source, ImportReport& report) {
    const Json none = Json::object();
    const Json* found = find(light, "spot");
    const Json& spot = found == nullptr ? none : *found;
    source.inner_cone = spot.value("innerConeAngle", 0.0);
    source.outer_cone = spot.value("outerConeAngle", std::numbers::pi / 4);
    if (source.inner_cone < source.outer_cone) return;
    constexpr double narrowest = 1e-3;  // of an edge, and of a cone
    source.outer_cone = std::max(source.outer_cone, narrowest);
    source.inner_cone = source.outer_cone * (1 - narrowest);
    report.add(Treatment::approximated, "cone of a spot light", path,
               "its innerConeAngle is not below its outerConeAngle; Tandem uses a sharp edge at the outer angle");
}

/// Kernels read colour times intensity, as floats.
void limit_brightness(const std::string& path, LightSource& source, ImportReport& report) {
    constexpr float largest = std::numeric_limits<float>::max();
    const float brightest = std::max({source.colour.x, source.colour.y, source.colour.z});
    if (!(double{brightest} * double{source.intensity} > double{largest})) return;
    source.intensity = std::nextafter(largest / brightest, 0.0F);
    report.add(Treatment::approximated, "brightness of a light", path,
               "its color times its intensity is above 3.4e38; Tandem uses that limit");
}

}  // namespace

std::optional<LightSource> read_light(const Json& light, const std::string& path, ImportReport& report) {
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
    if (source.kind == LightKind::spot) read_cone(light, path, source, report);
    const Json* phong = find_extension(light, "TANDEM_lights_phong");
    const bool falls_off = phong == nullptr || phong->value("falloff", true);
    source.casts_shadows = phong == nullptr || phong->value("shadows", true);
    source.inverse_square = falls_off && source.kind != LightKind::directional;
    // so that a surface in Phong's model is as bright as a Lambertian one under that illuminance
    if (falls_off) source.intensity = static_cast<float>(source.intensity / std::numbers::pi);
    limit_brightness(path, source, report);
    report.add(Treatment::rendered, feature, path,
               falls_off ? "intensity in candela, or in lux for directional lights"
                         : "Phong's model uses colour times intensity");
    return source;
}

}  // namespace tandem::gltf
