/// A scene from what a user types.
#pragma once

#include <string>

#include "tandem/scene/scene.h"

namespace tandem {

/// `specification` is "named:NAME" (named_scenes.h) or the path of a .gltf or .glb file (gltf/import.h). Throws
/// InputError. What a file uses and Tandem does not render is reported by the importer; pass `report` to have it.
[[nodiscard]] Scene load_scene(const std::string& specification);

}  // namespace tandem
