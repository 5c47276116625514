/// TANDEM_display: exposure and transfer function of 8-bit images.
#pragma once

#include "tandem/gltf/document.h"
#include "tandem/gltf/report.h"
#include "tandem/images/display.h"

namespace tandem::gltf {

/// TANDEM_display of the scene, else of the root, else the default. `scene` may be null.
[[nodiscard]] Display read_display(const Document& document, const Json* scene, const std::string& scene_path,
                                   ImportReport& report);

}  // namespace tandem::gltf
