/// The kernels that turn a binary tree into nodes of four children. Included by build_bvh.cu.
#pragma once

#include <cub/block/block_scan.cuh>

#include "cuda/entry_kernels.h"
#include "cuda/leaf_items.h"
#include "cuda/scene_bounds.h"

namespace tandem::cuda {

/// A node of four children before it is written.
struct alignas(8) WidePlan {
    std::uint32_t child[bvh_width];  ///< binary nodes, or no_binary_node; at first only the one that it replaces
    std::int32_t first_inner, first_entry;
};
inline constexpr std::uint32_t no_binary_node = 0xFFFFFFFFU;

/// A level of the plan.
struct PlanLevel {
    std::uint32_t begin, end;  ///< its nodes, among all
    std::uint32_t entries;     ///< of the levels before

    [[nodiscard]] __host__ __device__ std::uint32_t size() const { return end - begin; }
    /// The level after it; `children`: of this one. With the children of its first nodes alone, those of the next node
    /// start at `end` and `entries`.
    [[nodiscard]] __host__ __device__ PlanLevel next(Counts children) const {
        return {end, end + high_of(children), entries + low_of(children)};
    }
};

/// Finds the children of a node, and counts them. High: inner children; low: leaves.
__device__ inline Counts find_children(const BuildTree& tree, WidePlan& plan) {
    std::uint32_t inner = 0, leaves = 0;
    const WideChildren children = wide_children(tree, plan.child[0]);
    for (int k = 0; k < bvh_width; ++k) {
        plan.child[k] = k < children.count ? children.node[k] : no_binary_node;
        if (k < children.count) ++(tree.is_leaf(children.node[k]) ? leaves : inner);
    }
    return counts(inner, leaves);
}

/// Gives the children of node `i` of a level their places. `before`: the children of the nodes before.
__device__ inline void place_children(const BuildTree& tree, WidePlan* nodes, const PlanLevel& level, std::uint32_t i,
                                      Counts before) {
    WidePlan& plan = nodes[level.begin + i];
    const PlanLevel place = level.next(before);
    std::uint32_t inner = place.end;
    plan.first_inner = static_cast<std::int32_t>(inner);
    plan.first_entry = static_cast<std::int32_t>(place.entries);
    for (const std::uint32_t child : plan.child) {
        if (child != no_binary_node && !tree.is_leaf(child)) nodes[inner++].child[0] = child;
    }
}

/// find_children() for a level. The sums have one more element, for the total.
static __global__ void find_children_kernel(BuildTree tree, WidePlan* nodes, PlanLevel level, Counts* sums) {
    const std::uint32_t i = thread_number();
    if (i <= level.size()) sums[i] = i < level.size() ? find_children(tree, nodes[level.begin + i]) : 0;
}
static __global__ void place_children_kernel(BuildTree tree, WidePlan* nodes, PlanLevel level, const Counts* sums) {
    const std::uint32_t i = thread_number();
    if (i < level.size()) place_children(tree, nodes, level, i, sums[i]);
}

/// Levels that one block has planned, one after the other.
struct PlannedLevels {
    static constexpr std::uint32_t most = 32;
    PlanLevel next[most];  ///< what follows each of them
    std::uint32_t count;
};

/// Plans levels of at most a block of nodes, so that the host need not wait for the size of each.
static __global__ void small_levels_kernel(BuildTree tree, WidePlan* nodes, PlanLevel level, PlannedLevels* planned) {
    using Scan = cub::BlockScan<Counts, build_block>;
    __shared__ typename Scan::TempStorage memory;
    std::uint32_t count = 0;
    for (; count < PlannedLevels::most && level.size() != 0 && level.size() <= build_block; ++count) {
        const bool has_node = threadIdx.x < level.size();
        const Counts own = has_node ? find_children(tree, nodes[level.begin + threadIdx.x]) : 0;
        Counts before, all;
        Scan(memory).ExclusiveSum(own, before, all);
        if (has_node) place_children(tree, nodes, level, threadIdx.x, before);
        level = level.next(all);
        if (threadIdx.x == 0) planned->next[count] = level;
        __syncthreads();  // the nodes of the next level are there, and the memory is free
    }
    if (threadIdx.x == 0) planned->count = count;
}

static __global__ void nodes_kernel(LeafItems items, BuildTree tree, const WidePlan* plans, std::uint32_t count,
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
        const auto entry = static_cast<std::uint32_t>(plan.first_entry + all - inner);
        write_entry(items.scene, to, entry, leaf.first);
        if (to.pieces != nullptr) to.pieces[entry] = items.pieces[leaf.second];
        boxes[all++] = leaf.box;
    }
    to.nodes[i] = make_node(boxes, all, inner, plan.first_inner, plan.first_entry);
}

}  // namespace tandem::cuda
