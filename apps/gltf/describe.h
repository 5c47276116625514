/// The contents of a scene, for people and for programs.
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

/// Sentences that say why a scene cannot be rendered at some of its frames; at most 240 of them, spread evenly over
/// the animation and with its first and last, are prepared.
[[nodiscard]] std::vector<std::string> problems_of(const Scene& scene);

}  // namespace tandem
