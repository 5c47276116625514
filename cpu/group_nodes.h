/// The nodes of the hierarchy of groups, which single rays traverse (docs/performance/cpu.md).
#pragma once

#include "cpu/primitive_groups.h"
#include "tandem/math/aabb.h"

namespace tandem {

/// The most children of a node.
inline constexpr int group_node_width = 8;

/// A child of a node is the number of a node, or the number of a group with this bit set.
inline constexpr std::uint32_t group_bit = 0x80000000U;

/// The boxes of up to eight children. Where there is no child they are empty, so that no ray enters them.
struct alignas(64) GroupNode {
    float plane[6][group_node_width];  ///< the lower ones by axis, then the upper ones
    std::uint32_t child[group_node_width];
};
static_assert(sizeof(GroupNode) == 256);

/// A part of the tree.
struct GroupChild {
    Aabb box;  ///< not padded
    std::uint32_t number;
};

/// The node of the children [0, count), whose boxes are padded by `margin`, metres.
inline GroupNode make_group_node(const GroupChild* children, std::uint32_t count, float margin) {
    GroupNode node;
    for (std::uint32_t i = 0; i < group_node_width; ++i) {
        const Aabb box = i < count ? pad(children[i].box, margin) : Aabb{};
        const float lower[] = {box.lower.x, box.lower.y, box.lower.z};
        const float upper[] = {box.upper.x, box.upper.y, box.upper.z};
        for (int axis = 0; axis < 3; ++axis) {
            node.plane[axis][i] = lower[axis];
            node.plane[3 + axis][i] = upper[axis];
        }
        node.child[i] = i < count ? children[i].number : 0;
    }
    return node;
}

}  // namespace tandem
