/// The kernels that turn a binary tree into nodes of four children. Included by build_bvh.cu.
#pragma once

#include "cuda/entry_kernels.h"

namespace tandem::cuda {

/// A node of four children before it is written.
struct alignas(8) WidePlan {
    std::uint32_t child[bvh_width];  ///< binary nodes, or no_binary_node; at first only the one that it replaces
    std::int32_t first_inner, first_entry;
};
inline constexpr std::uint32_t no_binary_node = 0xFFFFFFFFU;

/// Finds the children of a level, and counts them. High: inner children; low: leaves. One more element for the sum.
static __global__ void find_children_kernel(BuildTree tree, WidePlan* level, std::uint32_t count, Counts* sums) {
    const std::uint32_t i = thread_number();
    if (i > count) return;
    std::uint32_t inner = 0, leaves = 0;
    if (i < count) {
        const WideChildren children = wide_children(tree, level[i].child[0]);
        for (int k = 0; k < bvh_width; ++k) {
            level[i].child[k] = k < children.count ? children.node[k] : no_binary_node;
            if (k < children.count) ++(tree.is_leaf(children.node[k]) ? leaves : inner);
        }
    }
    sums[i] = counts(inner, leaves);
}

/// Gives the children of a level their places. `end`: of the level, in all nodes; `entries`: of the levels before.
static __global__ void place_children_kernel(BuildTree tree, WidePlan* nodes, std::uint32_t begin, std::uint32_t end,
                                             std::uint32_t entries, const Counts* sums) {
    const std::uint32_t i = thread_number();
    if (i >= end - begin) return;
    WidePlan& plan = nodes[begin + i];
    std::uint32_t inner = end + high_of(sums[i]);
    plan.first_inner = static_cast<std::int32_t>(inner);
    plan.first_entry = static_cast<std::int32_t>(entries + low_of(sums[i]));
    for (const std::uint32_t child : plan.child) {
        if (child != no_binary_node && !tree.is_leaf(child)) nodes[inner++].child[0] = child;
    }
}

static __global__ void nodes_kernel(SceneView scene, BuildTree tree, const WidePlan* plans, std::uint32_t count,
                                    TreeArrays to) {
    const std::uint32_t i = thread_number();
    if (i >= count) return;
    const WidePlan plan = plans[i];
    Aabb boxes[bvh_width];
    int inner = 0;
    for (const std::uint32_t child : plan.child) {
        if (child != no_binary_node && !tree.is_leaf(child)) boxes[inner++] = tree.nodes[child].box;
    }
    int all = inner;
    for (const std::uint32_t child : plan.child) {
        if (child == no_binary_node || !tree.is_leaf(child)) continue;
        const BuildNode& leaf = tree.nodes[child];
        write_entry(scene, to, static_cast<std::uint32_t>(plan.first_entry + all - inner), leaf.first);
        boxes[all++] = leaf.box;
    }
    to.nodes[i] = make_node(boxes, all, inner, plan.first_inner, plan.first_entry);
}

}  // namespace tandem::cuda
