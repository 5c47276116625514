/// Lights: KHR_lights_punctual and TANDEM_lights_phong.
#pragma once

#include <optional>

#include "tandem/gltf/document.h"
#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem::gltf {

/// `light`: an element of KHR_lights_punctual.lights; `path`: the use of it by a node. Nothing for a light of a type
/// that the extension does not know.
[[nodiscard]] std::optional<LightSource> read_light(const Json& light, const std::string& path, ImportReport& report);

}  // namespace tandem::gltf
