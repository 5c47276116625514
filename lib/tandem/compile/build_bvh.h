/// Builds the BVHs that the CUDA backend traverses.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tandem/kernel/traversal/bvh.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem {

/// A BVH in host memory. Leaf entries are in the order of the leaves: the bounding sphere of a primitive (of a sphere,
/// the sphere itself), which rejects most rays, and the primitive's id.
struct Bvh {
    std::vector<BvhNode> nodes;  ///< the root is nodes[0]
    std::vector<Sphere> entry_spheres;
    std::vector<std::uint32_t> entry_ids;
};

/// Surface area heuristic over 16 bins per axis; deterministic. `margin`: padding of every box
/// (kernel/traversal/proposal.h). Throws InputError for more than max_bvh_primitives. The scene must not be empty.
[[nodiscard]] Bvh build_bvh(const SceneView& scene, float margin);

/// What is wrong with a BVH (a primitive missing or twice, a box that does not contain its child, too deep); empty if
/// nothing is. For tests and debugging.
[[nodiscard]] std::string find_bvh_defect(const Bvh& bvh, const SceneView& scene, float margin);

}  // namespace tandem
