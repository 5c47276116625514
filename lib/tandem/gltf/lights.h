/// Reads lights: KHR_lights_punctual and TANDEM_lights_phong.
#pragma once

#include <optional>

#include "tandem/gltf/document.h"
#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem::gltf {

/// `light`: an element of KHR_lights_punctual.lights; `path`: its use by a node. Empty for a light of an unknown type.
[[nodiscard]] std::optional<LightSource> read_light(const Json& light, const std::string& path, ImportReport& report);

}  // namespace tandem::gltf
