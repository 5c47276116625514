#include "tandem/gltf/environment.h"

#include <fmt/format.h>

#include <utility>

#include "tandem/base/error.h"
#include "tandem/base/lfs_pointer.h"
#include "tandem/gltf/materials.h"
#include "tandem/gltf/scene_extension.h"
#include "tandem/gltf/uris.h"
#include "tandem/scene/read_environment.h"

namespace tandem::gltf {

namespace {

EnvironmentFile read_picture(const Document& document, const std::string& json_path, const std::string& uri) {
    if (uri.starts_with("data:")) {
        document.fail(json_path, "embeds a picture; name a .hdr, .exr or .pfm file beside the glTF file instead");
    }
    const LocatedFile located = locate_beside(document, json_path, uri);
    if (located.is_lfs_pointer) {
        document.fail(json_path, fmt::format("names '{}', which {}", located.name, lfs_advice));
    }
    try {
        return tandem::read_environment(located.path.string());
    } catch (const InputError& error) {
        document.fail(json_path, error.what());
    }
}

}  // namespace

bool read_environment(const Document& document, const Json* scene, const std::string& scene_path, Scene& result,
                      ImportReport& report) {
    constexpr const char* name = "TANDEM_environment";
    const auto [found, path] = find_scene_extension(document, scene, scene_path, name, report);
    result.environment = {};
    if (found == nullptr) return false;
    Environment& environment = result.environment;
    const Json* uri = find(*found, "uri");
    report.add(Treatment::rendered, name, path,
               uri != nullptr ? "a picture as background" : "background and ambient light");
    if (const Json* gradient = find(*found, "gradient")) {
        environment.bottom = read_colour(*gradient, "bottom", environment.bottom);
        environment.top = read_colour(*gradient, "top", environment.top);
    }
    environment.illuminates = found->value("illuminates", uri != nullptr) ? 1U : 0U;
    result.indirect_light = found->value("indirect", false);
    // computed light replaces the ambient term
    if (environment.illuminates != 0 || result.indirect_light) environment.ambient = {0, 0, 0};
    environment.ambient = read_colour(*found, "ambient", environment.ambient);
    if (uri == nullptr) return true;
    const std::string uri_path = path + ".uri";
    EnvironmentFile file = read_picture(document, uri_path, uri->get<std::string>());
    if (file.negative_texels > 0) {
        report.add(Treatment::approximated, "negative light", uri_path,
                   fmt::format("{} texels have negative values, which become 0", file.negative_texels));
    }
    result.environment_image = {std::move(file.picture), found->value("rotation", 0.0),
                                found->value("intensity", 1.0F)};
    return true;
}

}  // namespace tandem::gltf
