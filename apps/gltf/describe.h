/// Describes the contents of a scene, as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem {

/// Counts, names, cameras, lights, materials, animation and the import report of a scene.
[[nodiscard]] nlohmann::ordered_json describe(const std::string& specification, const Scene& scene,
                                              const ImportReport& report);

/// The same as text.
[[nodiscard]] std::string to_text(const nlohmann::ordered_json& description);

/// Why a scene cannot be rendered at some of its frames, one sentence each. At most 240 frames are tried, spread evenly
/// over the animation and including its first and last.
[[nodiscard]] std::vector<std::string> problems_of(const Scene& scene);

}  // namespace tandem
