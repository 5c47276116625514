/// Extensions of a scene, or of the root of a file for scenes without them.
#pragma once

#include "tandem/gltf/document.h"
#include "tandem/gltf/report.h"

namespace tandem::gltf {

struct SceneExtension {
    const Json* content = nullptr;  ///< null if there is none
    std::string path;
};

/// The extension `name` of the scene, else of the root. `scene` may be null. Notes an extension of the root that the
/// scene's own overrides.
[[nodiscard]] SceneExtension find_scene_extension(const Document& document, const Json* scene,
                                                  const std::string& scene_path, const char* name,
                                                  ImportReport& report);

}  // namespace tandem::gltf
