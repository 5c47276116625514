/// The binary tree from which build_bvh.cu makes a BVH. Included by .cu files.
#pragma once

#include "tandem/kernel/traversal/collapse.h"
#include "tandem/math/aabb.h"

namespace tandem::cuda {

/// A node. Leaves come first, in the order of the curve.
struct alignas(16) BuildNode {
    Aabb box;                     ///< padded
    std::uint32_t first, second;  ///< children; of a leaf, the id of the primitive, and the item (leaf_items.h)
};
static_assert(sizeof(BuildNode) == 32);

inline constexpr std::uint32_t no_parent = 0xFFFFFFFFU;

struct BuildTree {
    BuildNode* nodes;
    std::uint32_t* parents;  ///< by node; no_parent of the root
    Forests* of;             ///< by node
    std::uint32_t leaves;

    __device__ bool is_leaf(std::uint32_t node) const { return node < leaves; }
    __device__ std::uint32_t first(std::uint32_t node) const { return nodes[node].first; }
    __device__ std::uint32_t second(std::uint32_t node) const { return nodes[node].second; }
    __device__ const Forests& forests(std::uint32_t node) const { return of[node]; }
    __device__ std::uint32_t sibling(std::uint32_t node) const {
        const BuildNode& parent = nodes[parents[node]];
        return parent.first == node ? parent.second : parent.first;
    }
};

/// Two counts that are summed together.
using Counts = std::uint64_t;
__host__ __device__ inline Counts counts(std::uint32_t high, std::uint32_t low) { return Counts{high} << 32 | low; }
__host__ __device__ inline std::uint32_t high_of(Counts counts) { return static_cast<std::uint32_t>(counts >> 32); }
__host__ __device__ inline std::uint32_t low_of(Counts counts) { return static_cast<std::uint32_t>(counts); }

__device__ inline std::uint32_t thread_number() { return blockIdx.x * blockDim.x + threadIdx.x; }

}  // namespace tandem::cuda
