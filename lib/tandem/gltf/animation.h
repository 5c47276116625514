/// Reads the animation channels of a file.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tandem/gltf/buffers.h"
#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem::gltf {

/// Adds the channels of the first animation to the scene. `node_of`: the number in the scene of each node of the file,
/// if the scene has it. A channel with a flaw is left out.
void read_animation(const Source& source, const std::vector<std::optional<std::uint32_t>>& node_of, Scene& scene,
                    ImportReport& report, FlawLog& flaws);

/// Notes an animation that continues after the last possible frame.
void note_length(const Scene& scene, ImportReport& report);

}  // namespace tandem::gltf
