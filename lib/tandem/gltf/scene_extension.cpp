#include "tandem/gltf/scene_extension.h"

#include <fmt/format.h>

namespace tandem::gltf {

SceneExtension find_scene_extension(const Document& document, const Json* scene, const std::string& scene_path,
                                    const char* name, ImportReport& report) {
    const Json* of_scene = scene == nullptr ? nullptr : find_extension(*scene, name);
    const Json* of_root = find_extension(document.json, name);
    const std::string root_path = fmt::format("extensions.{}", name);
    if (of_scene == nullptr) return {of_root, root_path};
    if (of_root != nullptr) {
        report.add(Treatment::ignored, fmt::format("{} of the file", name), root_path, "the scene has its own");
    }
    return {of_scene, scene_path + "." + root_path};
}

}  // namespace tandem::gltf
