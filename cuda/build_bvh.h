/// Builds the BVH of a scene on the GPU.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "cuda/memory.h"
#include "tandem/kernel/traversal/bvh_walk.h"

namespace tandem::cuda {

/// Piece `number` of the `count` of a primitive.
struct alignas(8) Piece {
    std::uint32_t primitive;
    std::uint16_t number, count;
};

/// The parts of a tree in GPU memory.
struct TreeArrays {
    BvhNode* nodes;
    Sphere* spheres;
    std::uint32_t* ids;
    EntryTriangle* triangles;  ///< null unless all primitives are triangles
    RoughPlacement* placements;
    bool placed_by_entry;
    Piece* pieces;  ///< by entry; null where every entry is a whole primitive
};

/// A BVH in GPU memory, as kernels read it.
struct BuiltBvh {
    BvhView view;
    std::uint32_t node_count = 0;
    std::uint32_t entry_count = 0;  ///< without the spare ones; more than the primitives if some are in pieces
    std::uint32_t levels = 0;       ///< of nodes; at most max_bvh_depth
    std::vector<std::uint32_t>
        level_starts;     ///< the first node of each level, then node_count; children are a level below
    TreeArrays arrays{};  ///< the same memory as `view`, to be written
    /// By the surface area heuristic with the weights of kernel/traversal/collapse.h, relative to the area of the
    /// scene's padded bounds; and half of that area, square metres.
    double cost = 0, root_area = 0;
};

/// Whether a node has a child of that number; those that are there come first.
TANDEM_HD_INLINE bool has_child(const BvhNode& node, int child) {
    return (node.lower_x >> (8 * child) & 255U) <= (node.upper_x >> (8 * child) & 255U);
}

/// The work that a build spends on the quality of the tree.
struct BuildEffort {
    std::uint32_t top_clusters;  ///< how many clusters are joined from the top down, on the host; 1: none
    int passes;                  ///< how often subtrees move to better places
    bool far;                    ///< clusters look for the nearest within 12 places of the curve, else within 8
    bool cuts = true;            ///< long, thin primitives are cut into pieces, each with a box of its own
    std::uint32_t most_leaves =
        0;  ///< with more pieces than that, nothing is cut; 0: that the free memory is enough for
};

/// For a scene of that many primitives. Chosen by measurement (docs/performance/hierarchies.md).
[[nodiscard]] constexpr BuildEffort effort_for(std::uint32_t primitives) {
    return primitives <= 2'000'000 ? BuildEffort{4096, 8, true} : BuildEffort{512, 0, false};
}

/// The least GPU memory that a hierarchy takes while it is built, in bytes per primitive.
inline constexpr std::size_t build_bytes_per_primitive = 200;

/// The GPU memory that a build uses.
struct BuildMemory {
    Buffer<DeviceMemory> tree;     ///< receives the BVH
    Buffer<DeviceMemory> scratch;  ///< about 200 bytes a primitive; free after the build
    Buffer<PinnedMemory> word;     ///< for single values that the host reads
};

/// Builds the BVH of a scene whose arrays are in GPU memory. Waits for the stream.
///
/// Method: sorts the centres of the primitives along a Morton curve of 63 bits. Long, thin primitives are then cut, and
///         their pieces sorted again (cut_kernels.h). Then neighbours on the curve merge,
///         pair by pair and in parallel, if each is the other's nearest within a radius; nearest means the smallest
///         area of the common box. Ties go to the pair whose places differ least in their high bits, which is the same
///         for both, so that something merges in every round. If the number of rounds could exceed the depth limit,
///         neighbours merge whatever their areas. The last few thousand clusters are joined from the top down
///         (compile/binary_tree.h): large boxes then overlap less, which the areas alone do not show. Then subtrees
///         move to better places (reinsertion_kernels.h). Finally the binary tree becomes nodes of four children
///         (kernel/traversal/collapse.h), level by level. Places come from prefix sums, and moves compete by their
///         gains, so the same scene always gives the same bytes.
/// Source: D. Meister, J. Bittner, "Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy Construction",
///         IEEE TVCG 24(3), 2018.
/// Throws InputError for more than max_bvh_primitives, and EnvironmentError if the GPU lacks the memory. The scene must
/// not be empty. Tested by tests/cuda/build_bvh_test.cpp.
[[nodiscard]] BuiltBvh build_bvh(const SceneView& scene, BuildMemory& memory, cudaStream_t stream,
                                 const BuildEffort& effort);

}  // namespace tandem::cuda
