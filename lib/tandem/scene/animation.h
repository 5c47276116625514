/// Animation: the transforms of the nodes at a time.
#pragma once

#include <vector>

#include "tandem/scene/scene.h"

namespace tandem {

/// For every node its transform relative to its parent at `time` seconds, with all channels applied. The scene must
/// be valid (validate()).
/// Interpolation as in glTF 2.0, appendix C: step, linear (rotations by spherical interpolation along the shorter
/// arc), cubic Hermite spline (rotations are normalised when they become matrices).
[[nodiscard]] std::vector<Transform> parents_from_nodes(const Scene& scene, double time);

/// The same for every node relative to the world.
[[nodiscard]] std::vector<Transform> world_from_nodes(const Scene& scene, double time);

/// Does the channel take different values at times between `from` and `to`, both excluded? Exact, but for rotations
/// whose quaternions change in length alone: they count as changes.
[[nodiscard]] bool changes_between(const AnimationChannel& channel, double from, double to);

/// All nodes, each of them behind its parent. Linear in their number, however deep the tree is.
[[nodiscard]] std::vector<std::size_t> parents_first(const Scene& scene);

}  // namespace tandem
