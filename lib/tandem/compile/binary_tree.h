/// A binary tree of boxes over the primitives, from which build_bvh() makes nodes of four children.
#pragma once

#include <cstdint>
#include <vector>

#include "tandem/kernel/traversal/bvh.h"
#include "tandem/kernel/traversal/proposal.h"
#include "tandem/math/aabb.h"

namespace tandem {

/// In preorder: the first child of node i is node i + 1.
struct BinaryNode {
    Aabb box;                       ///< of all primitives below, padded
    std::uint32_t second;           ///< the index of the second child; 0 for a leaf, which holds one primitive
    std::uint32_t first_primitive;  ///< a place in `order`

    [[nodiscard]] bool is_leaf() const { return second == 0; }
};

struct BinaryTree {
    std::vector<BinaryNode> nodes;     ///< the root is nodes[0]
    std::vector<std::uint32_t> order;  ///< ids of primitives, those of each node next to one another
};

/// Surface area heuristic over 16 bins per axis; deterministic; not deeper than max_bvh_depth. `padding`: of
/// every box (kernel/traversal/proposal.h). The scene must not be empty.
[[nodiscard]] BinaryTree build_binary_tree(const SceneView& scene, const Padding& padding);

/// The same over boxes; `order` has their indices.
[[nodiscard]] BinaryTree build_binary_tree(std::vector<Aabb> boxes);

}  // namespace tandem
