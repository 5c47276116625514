/// TANDEM_environment: the background of a scene.
#pragma once

#include "tandem/gltf/document.h"
#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem::gltf {

/// Reads TANDEM_environment of the scene, else of the root, into `result`; `scene` may be null. Returns whether there
/// is one. Throws a Flaw for a picture that cannot be read.
bool read_environment(const Document& document, const Json* scene, const std::string& scene_path, Scene& result,
                      ImportReport& report);

}  // namespace tandem::gltf
