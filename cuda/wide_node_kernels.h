/// The kernels that turn a binary tree into nodes of four children, and write the entries. Included by build_bvh.cu.
#pragma once

#include "cuda/build_tree.h"
#include "tandem/kernel/traversal/hit_interval.h"
#include "tandem/kernel/traversal/make_node.h"

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

/// The parts of a tree in memory.
struct TreeArrays {
    BvhNode* nodes;
    Sphere* spheres;
    std::uint32_t* ids;
    EntryTriangle* triangles;  ///< null unless all primitives are triangles
    RoughPlacement* placements;
    bool placed_by_entry;
};

__device__ inline void write_entry(const SceneView& scene, const TreeArrays& to, std::uint32_t entry,
                                   std::uint32_t id) {
    to.ids[entry] = id;
    if (to.triangles != nullptr) to.triangles[entry] = entry_triangle(scene.triangles[id], id);
    if (to.placed_by_entry) to.placements[entry] = rough_placement(scene.parallelepipeds[id]);
    visit_primitive(scene, id, [&](const auto& primitive) { to.spheres[entry] = sphere_around(primitive); });
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

/// Entries that children which are not there may name: those of the last primitive once more.
static __global__ void spare_entries_kernel(TreeArrays to, std::uint32_t count) {
    const std::uint32_t entry = count + threadIdx.x;
    to.ids[entry] = to.ids[count - 1];
    to.spheres[entry] = to.spheres[count - 1];
    if (to.triangles != nullptr) to.triangles[entry] = to.triangles[count - 1];
    if (to.placed_by_entry) to.placements[entry] = to.placements[count - 1];
}

static __global__ void placements_kernel(SceneView scene, RoughPlacement* placements) {
    const std::uint32_t i = thread_number();
    if (i < scene.ellipsoid_count) {
        placements[i] = rough_placement(scene.ellipsoids[i]);
    } else if (i < scene.ellipsoid_count + scene.parallelepiped_count) {
        placements[i] = rough_placement(scene.parallelepipeds[i - scene.ellipsoid_count]);
    }
}

}  // namespace tandem::cuda
