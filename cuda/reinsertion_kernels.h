/// The kernels that improve a binary tree: a subtree moves to where it makes the areas of all boxes smaller. Included
/// by build_bvh.cu.
/// Source: D. Meister, J. Bittner, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization", Computer Graphics
///         Forum 37(2), 2018.
#pragma once

#include "cuda/build_tree.h"

namespace tandem::cuda {

/// The best place for a subtree: `target` gets a new parent, whose other child is the subtree.
struct Move {
    float gain = 0;  ///< by how much the areas of all boxes shrink; 0 for no move
    std::uint32_t target = 0;
    std::uint32_t ancestor = 0;  ///< common to the subtree and the target
};

/// The box of an ancestor without the subtree is not stored, so it is merged again on the way up.
///
/// Method: climbs from the parent of the subtree. At each ancestor it searches the other child from the top. Leaving an
///         ancestor brings the area that it loses, going down into a node costs the area that it gains, and the new
///         parent costs its own area. A branch ends where even a new parent of the subtree's area would be no better
///         than the best place so far.
static __global__ void search_kernel(BuildTree tree, std::uint32_t nodes, Move* moves) {
    struct Open {
        std::uint32_t node;
        float gain;
    };
    constexpr int most_open = 48;
    const std::uint32_t node = thread_number();
    if (node >= nodes) return;
    Move best;
    const std::uint32_t parent = tree.parents[node];
    if (parent != no_parent && tree.parents[parent] != no_parent) {
        const Aabb box = tree.nodes[node].box;
        const float own_area = half_area(box);
        float gain = half_area(tree.nodes[parent].box);
        Aabb without;  // the ancestor's box without the subtree
        for (std::uint32_t from = node, ancestor = parent; ancestor != no_parent;
             from = ancestor, ancestor = tree.parents[ancestor]) {
            const std::uint32_t other = tree.sibling(from);
            Open open[most_open];
            int count = 1;
            open[0] = {other, gain};
            while (count > 0) {
                const Open at = open[--count];
                if (!(at.gain - own_area > best.gain)) continue;
                const BuildNode there = tree.nodes[at.node];
                const float merged = half_area(merge(there.box, box));
                if (at.gain - merged > best.gain) best = {at.gain - merged, at.node, ancestor};
                const float below = at.gain - (merged - half_area(there.box));
                if (tree.is_leaf(at.node) || !(below - own_area > best.gain) || count + 2 > most_open) continue;
                open[count++] = {there.second, below};
                open[count++] = {there.first, below};
            }
            const Aabb other_box = tree.nodes[other].box;
            if (from == node) {
                without = other_box;
            } else {
                without = merge(without, other_box);
                gain += half_area(tree.nodes[ancestor].box) - half_area(without);
            }
        }
    }
    moves[node] = best;
}

/// Calls visit(node) for all nodes that a move reads or changes: those on the paths from the subtree and from the
/// target to their common ancestor, and the neighbours of the parent that moves along. Moves that have no such node in
/// common can be made in any order, and make no cycle.
template <class Visit>
__device__ void visit_moved(const BuildTree& tree, std::uint32_t node, const Move& move, Visit visit) {
    const std::uint32_t parent = tree.parents[node];
    visit(tree.sibling(node));
    visit(tree.parents[parent]);
    for (std::uint32_t at = node; at != move.ancestor; at = tree.parents[at]) visit(at);
    for (std::uint32_t at = move.target; at != move.ancestor; at = tree.parents[at]) visit(at);
    visit(move.ancestor);
}

/// The larger gain wins a node; of equal ones, the larger number.
__device__ inline std::uint64_t claim_of(std::uint32_t node, const Move& move) {
    return std::uint64_t{bits_of(move.gain)} << 32 | node;
}

static __global__ void claim_kernel(BuildTree tree, std::uint32_t nodes, const Move* moves,
                                    unsigned long long* claims) {
    const std::uint32_t node = thread_number();
    if (node >= nodes || !(moves[node].gain > 0.0F)) return;
    const std::uint64_t claim = claim_of(node, moves[node]);
    visit_moved(tree, node, moves[node], [&](std::uint32_t at) { atomicMax(&claims[at], claim); });
}

/// Drops the moves that have not won all of their nodes.
static __global__ void drop_kernel(BuildTree tree, std::uint32_t nodes, Move* moves, const unsigned long long* claims) {
    const std::uint32_t node = thread_number();
    if (node >= nodes || !(moves[node].gain > 0.0F)) return;
    const std::uint64_t claim = claim_of(node, moves[node]);
    bool wins = true;
    visit_moved(tree, node, moves[node], [&](std::uint32_t at) { wins = wins && claims[at] == claim; });
    if (!wins) moves[node].gain = 0;
}

static __global__ void move_kernel(BuildTree tree, std::uint32_t nodes, const Move* moves) {
    const std::uint32_t node = thread_number();
    if (node >= nodes || !(moves[node].gain > 0.0F)) return;
    const auto replace = [&](std::uint32_t parent, std::uint32_t child, std::uint32_t by) {
        BuildNode& at = tree.nodes[parent];
        (at.first == child ? at.first : at.second) = by;
        tree.parents[by] = parent;
    };
    const std::uint32_t parent = tree.parents[node], sibling = tree.sibling(node), target = moves[node].target;
    replace(tree.parents[parent], parent, sibling);
    replace(tree.parents[target], target, parent);
    tree.nodes[parent].first = target;
    tree.nodes[parent].second = node;
    tree.parents[target] = parent;
}

/// Loads a value that another multiprocessor may have written, bypassing the L1 cache.
template <class T>
__device__ T load_fresh(const T* from) {
    static_assert(sizeof(T) % 16 == 0);
    uint4 words[sizeof(T) / 16];
    for (std::size_t i = 0; i < sizeof(T) / 16; ++i) words[i] = __ldcg(reinterpret_cast<const uint4*>(from) + i);
    T value;
    memcpy(&value, words, sizeof(T));
    return value;
}

/// Makes the boxes again from the leaves up, or, with `weighs`, the costs by which children of wide nodes are chosen.
/// Of the two threads that reach a node, the second continues. `arrivals`: zeros.
template <bool weighs>
static __global__ void climb_kernel(BuildTree tree, double whole, std::uint32_t* arrivals) {
    std::uint32_t node = thread_number();
    if (node >= tree.leaves) return;
    if (weighs) tree.of[node] = forests_of_leaf(relative_area(tree.nodes[node].box, whole));
    for (node = tree.parents[node]; node != no_parent; node = tree.parents[node]) {
        __threadfence();
        if (atomicAdd(&arrivals[node], 1U) == 0) return;
        __threadfence();
        const std::uint32_t first = tree.nodes[node].first, second = tree.nodes[node].second;
        if (weighs) {
            tree.of[node] = forests_of_node(relative_area(tree.nodes[node].box, whole), load_fresh(&tree.of[first]),
                                            load_fresh(&tree.of[second]));
        } else {
            tree.nodes[node].box = merge(load_fresh(&tree.nodes[first]).box, load_fresh(&tree.nodes[second]).box);
        }
    }
}

}  // namespace tandem::cuda
