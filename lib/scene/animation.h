/// Animation: where the nodes are at a time.
#pragma once

#include <vector>

#include "tandem/scene/scene.h"

namespace tandem {

/// For every node its transform relative to its parent at `time` seconds, with all channels applied. The scene must
/// be valid (validate()).
/// Interpolation as in glTF 2.0, appendix C: step, linear (rotations by spherical interpolation along the shorter
/// arc), cubic Hermite spline (rotations are normalised when they become matrices).
[[nodiscard]] std::vector<Transform> parents_from_nodes(const Scene& scene, double time);

}  // namespace tandem
