/// A scene from what a user types.
#pragma once

#include <string>

#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem {

/// `specification` is "named:NAME" (named_scenes.h) or the path of a .gltf or .glb file (gltf/import.h). Throws
/// InputError. What a file uses and Tandem renders otherwise or not at all is said by the importer: pass `report` to
/// have it. A named scene leaves the report empty.
[[nodiscard]] Scene load_scene(const std::string& specification, ImportReport* report = nullptr);

}  // namespace tandem
