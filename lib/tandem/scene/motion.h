/// Finds the nodes that move while a camera's shutter is open.
#pragma once

#include <cstdint>
#include <vector>

#include "tandem/scene/scene.h"

namespace tandem {

/// The nodes whose motion within the shutter interval is visible in a frame at `time` seconds: first the camera's, then
/// those with primitives, and those with lights if there are primitives. A node moves if a channel that drives it, or
/// an ancestor of it, takes different values between opening and closing: all keys are considered, so no motion is
/// missed, however short. Motions that cancel each other count as motion. Empty if the shutter is closed. The scene
/// must be valid.
[[nodiscard]] std::vector<std::size_t> nodes_in_motion(const Scene& scene, std::size_t camera, double time);

}  // namespace tandem
