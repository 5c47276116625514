/// The boxes of a node's children as numbers.
#pragma once

#include "tandem/kernel/traversal/make_node.h"

namespace tandem {

/// The box that node_ray.h tests for a child, in exact arithmetic, less the fraction of a step that rounding needs.
struct ChildBox {
    Vec3d lower, upper;
};

[[nodiscard]] inline ChildBox child_box(const BvhNode& node, unsigned child) {
    const auto plane = [&](unsigned axis, std::uint32_t planes, double inward) {
        const double step = make_node_detail::power_of_two(static_cast<int>(node.frame >> (8 * axis) & 255U) - 127 - 7);
        const double exact = node.corner[axis] + step * (planes >> (8 * child) & 255U);
        return exact + inward * step * 0x1p-8;
    };
    return {{plane(0, node.lower_x, 1), plane(1, node.lower_y, 1), plane(2, node.lower_z, 1)},
            {plane(0, node.upper_x, -1), plane(1, node.upper_y, -1), plane(2, node.upper_z, -1)}};
}

/// Whether it is the box of an absent child.
[[nodiscard]] inline bool is_empty(const ChildBox& box) { return box.lower.x > box.upper.x; }

}  // namespace tandem
