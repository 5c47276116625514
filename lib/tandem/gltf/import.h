/// Imports scenes from glTF 2.0 files. docs/scene-format.md describes what is read and how.
#pragma once

#include <filesystem>

#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem {

struct ImportResult {
    Scene scene;
    ImportReport report;
    std::string scene_path;        ///< JSON path of the scene, "scenes[0]"
    bool has_environment = false;  ///< TANDEM_environment defines the background
};

/// Reads a .gltf or .glb file, with its buffers and the images that its materials use. Files outside of its folder are
/// never opened.
///
/// The nodes of the default scene come in the order of the file's `nodes`; lengths in metres, angles in radians, as in
/// the file. The scene is valid (validate()).
/// Throws InputError, with file, JSON path, reason and what to do, for malformed input, for an invalid scene, and for a
/// required extension that Tandem does not render.
[[nodiscard]] ImportResult import_gltf(const std::filesystem::path& file);

}  // namespace tandem
