/// Animation: the transforms of all nodes at a time.
#pragma once

#include <vector>

#include "tandem/scene/scene.h"

namespace tandem {

/// The transform of every node relative to its parent at `time` seconds, with all channels applied. The scene must be
/// valid (validate()).
/// Interpolation as in glTF 2.0, appendix C: step, linear (rotations by spherical interpolation along the shorter
/// arc), cubic Hermite spline (rotations are normalised when they become matrices).
[[nodiscard]] std::vector<Transform> parents_from_nodes(const Scene& scene, double time);

/// The same, relative to the world.
[[nodiscard]] std::vector<Transform> world_from_nodes(const Scene& scene, double time);

/// Whether the channel takes different values at times between `from` and `to`, both excluded. Exact, except that a
/// rotation whose quaternion changes only in length counts as changing.
[[nodiscard]] bool changes_between(const AnimationChannel& channel, double from, double to);

/// All nodes, each of them after its parent. Linear in their number, whatever the depth of the tree.
[[nodiscard]] std::vector<std::size_t> parents_first(const Scene& scene);

}  // namespace tandem
