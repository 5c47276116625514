/// Which nodes of a binary tree become the children of a node of four, by the surface area heuristic.
/// Source: Ylitie et al. (kernel/traversal/bvh.h), section 3.1.
#pragma once

#include <cstdint>

#include "tandem/kernel/traversal/bvh.h"
#include "tandem/math/aabb.h"

namespace tandem {

/// The cheapest forests of k wide trees over the primitives below a binary node, for k < bvh_width.
struct alignas(16) Forests {
    float cost[bvh_width - 1];          ///< by k - 1, relative to the area of the root
    std::uint8_t for_first[bvh_width];  ///< by k - 1: how many go to the first child; 0: k - 1 of them are as cheap
};
static_assert(sizeof(Forests) == 16);

/// The area of a box over that of the root, `whole`.
TANDEM_HD_INLINE float relative_area(const Aabb& box, double whole) {
    return narrow(lesser(wide_half_area(box) / greater(whole, 1e-300), 1.0));
}

/// Of a leaf with one primitive.
TANDEM_HD_INLINE Forests forests_of_leaf(float area) {
    constexpr float leaf_cost = 0.6F;  // of a primitive, relative to that of a node
    Forests at{};
    for (float& cost : at.cost) cost = area * leaf_cost;
    return at;
}

namespace collapse_detail {

/// The cost of `places` trees in all, divided among the two children in the cheapest way.
TANDEM_HD_INLINE float divided_cost(const Forests& first, const Forests& second, int places, std::uint8_t& for_first) {
    float least = 0;
    for (int i = 1; i < places; ++i) {
        const float cost = first.cost[i - 1] + second.cost[places - i - 1];
        if (i > 1 && !(cost < least)) continue;
        least = cost;
        for_first = static_cast<std::uint8_t>(i);
    }
    return least;
}

}  // namespace collapse_detail

/// Of a node of that relative area with two children.
TANDEM_HD_INLINE Forests forests_of_node(float area, const Forests& first, const Forests& second) {
    using collapse_detail::divided_cost;
    Forests at{};
    at.cost[0] = divided_cost(first, second, bvh_width, at.for_first[bvh_width - 1]) + area;
    for (int places = 2; places < bvh_width; ++places) {
        const float divided = divided_cost(first, second, places, at.for_first[places - 1]);
        const float undivided = at.cost[places - 2];
        if (!(divided < undivided)) at.for_first[places - 1] = 0;
        at.cost[places - 1] = lesser(divided, undivided);
    }
    return at;
}

/// The children of a wide node.
struct WideChildren {
    std::uint32_t node[bvh_width];
    int count = 0;
};

/// Those of the wide node that replaces binary node `root`: at least two, unless the root is a leaf. A `Tree` has
/// forests(node), first(node), second(node) and is_leaf(node).
template <class Tree>
TANDEM_HD_INLINE WideChildren wide_children(const Tree& tree, std::uint32_t root) {
    struct Part {
        std::uint32_t node;
        int places;
    };
    WideChildren children;
    Part open[bvh_width];
    int count = 1;
    open[0] = {root, tree.is_leaf(root) ? 1 : bvh_width};
    while (count > 0) {
        const Part part = open[--count];
        int places = part.places;
        const Forests at = tree.forests(part.node);
        while (places > 1 && at.for_first[places - 1] == 0) --places;
        if (places == 1) {
            children.node[children.count++] = part.node;
            continue;
        }
        const int for_first = at.for_first[places - 1];
        open[count++] = {tree.second(part.node), places - for_first};
        open[count++] = {tree.first(part.node), for_first};
    }
    return children;
}

}  // namespace tandem
