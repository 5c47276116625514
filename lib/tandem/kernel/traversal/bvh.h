/// The binary BVH of the CUDA backend.
#pragma once

#include <cstdint>

#include "tandem/kernel/shapes/sphere.h"
#include "tandem/kernel/view/scene_view.h"
#include "tandem/math/aabb.h"
#include "tandem/math/host_device.h"

namespace tandem {

/// The boxes and indices of both children, 64 bytes: one traversal step reads it with four 16-byte loads.
struct alignas(16) BvhNode {
    float xy[2][4];         ///< by child: lower x, upper x, lower y, upper y
    float z[4];             ///< lower z, upper z of child 0, then of child 1
    std::int32_t child[2];  ///< 0 or more: index of a node; negative: ~code of a leaf
    std::int32_t unused[2];
};
static_assert(sizeof(BvhNode) == 64);

/// A leaf holds entries [first, first + count): code = first * 8 + (count - 1).
inline constexpr int max_leaf_size = 8;
inline constexpr std::uint32_t max_bvh_primitives = 1U << 28;
TANDEM_HD_INLINE constexpr std::int32_t leaf_child(std::uint32_t first, std::uint32_t count) {
    return ~static_cast<std::int32_t>(first * 8 + (count - 1));
}
TANDEM_HD_INLINE std::uint32_t leaf_first(std::int32_t child) { return static_cast<std::uint32_t>(~child) >> 3; }
TANDEM_HD_INLINE std::uint32_t leaf_count(std::int32_t child) { return (static_cast<std::uint32_t>(~child) & 7U) + 1; }

/// The depth limit of build_bvh(), so a traversal stack of this size cannot overflow.
inline constexpr int max_bvh_depth = 64;

}  // namespace tandem
