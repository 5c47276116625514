/// What moves while a camera's shutter is open.
#pragma once

#include <cstdint>
#include <vector>

#include "tandem/scene/scene.h"

namespace tandem {

/// The nodes whose motion within the shutter's interval a frame at `time`, in seconds, shows: the camera's, first, and
/// those with primitives or with lights that shine on some. A node moves if a channel that drives it, or an ancestor of
/// it, takes different values between opening and closing: all keys are considered, so no motion is missed, however
/// short. Motions that cancel each other count as motion. Empty where the shutter is closed. The scene must be valid.
[[nodiscard]] std::vector<std::size_t> nodes_in_motion(const Scene& scene, std::size_t camera, double time);

}  // namespace tandem
