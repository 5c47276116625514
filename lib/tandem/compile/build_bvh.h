/// Builds the BVHs that the CUDA backend traverses.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tandem/kernel/traversal/bvh.h"
#include "tandem/kernel/traversal/hit_interval.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem {

/// A BVH in host memory. An entry is the bounding sphere of a primitive (of a sphere, the sphere itself), which rejects
/// most rays, and the primitive's id.
struct Bvh {
    std::vector<BvhNode> nodes;  ///< the root is nodes[0]
    std::vector<Sphere> entry_spheres;
    std::vector<std::uint32_t> entry_ids;
    std::vector<RoughPlacement> placements;      ///< of the ellipsoids, then the parallelepipeds; or placed_by_entry()
    std::vector<EntryTriangle> entry_triangles;  ///< if all primitives are triangles
};

/// Surface area heuristic; deterministic. `padding`: of every box (kernel/traversal/proposal.h). Throws
/// InputError for more than max_bvh_primitives. The scene must not be empty.
[[nodiscard]] Bvh build_bvh(const SceneView& scene, const Padding& padding);

/// Throws InputError for more primitives than max_bvh_primitives.
void check_bvh_size(std::uint32_t primitives);

/// What is wrong with a BVH (a primitive missing or twice, or not in the boxes on the way to it, too deep); empty if
/// nothing is. For tests and debugging.
[[nodiscard]] std::string find_bvh_defect(const Bvh& bvh, const SceneView& scene, const Padding& padding);

}  // namespace tandem
