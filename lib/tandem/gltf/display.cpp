#include "tandem/gltf/display.h"

#include <fmt/format.h>

#include "tandem/gltf/scene_extension.h"

namespace tandem::gltf {

Display read_display(const Document& document, const Json* scene, const std::string& scene_path, ImportReport& report) {
    constexpr const char* name = "TANDEM_display";
    const auto [content, path] = find_scene_extension(document, scene, scene_path, name, report);
    Display display;
    if (content == nullptr) return display;
    if (const Json* transfer = find(*content, "transfer"))
        display.transfer = parse_transfer(transfer->get<std::string>());
    display.exposure_stops = content->value("exposure", display.exposure_stops);
    report.add(Treatment::rendered, name, path, "8-bit images are " + in_words(display));
    return display;
}

}  // namespace tandem::gltf
