/// The hierarchy of the CUDA backend: nodes of four children with boxes in bytes.
/// Source: H. Ylitie, T. Karras, S. Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs",
///         HPG 2017, section 3; here four children, and one primitive a leaf.
#pragma once

#include <cstdint>

#include "tandem/kernel/shapes/sphere.h"
#include "tandem/kernel/view/scene_view.h"
#include "tandem/math/host_device.h"

namespace tandem {

inline constexpr int bvh_width = 4;
/// The number of spare entries after those of all primitives: absent children may refer to them.
inline constexpr int spare_entries = bvh_width - 1;

/// The planes of the children's boxes are multiples of the node's steps, from its corner: 48 bytes, three loads of 16.
/// Inner children come first. An absent child has an empty box; rounding may let a ray enter it, so its entry
/// exists as well.
struct alignas(16) BvhNode {
    float corner[3];
    std::uint32_t frame;       ///< a byte per axis: the exponent of 128 steps, as in a float; then the inner children
    std::int32_t first_inner;  ///< the index of the first inner child; the others follow it
    std::int32_t leaf_base;    ///< child i >= number of inner children is ~(leaf_base - i), an entry
    std::uint32_t lower_x, upper_x, lower_y, upper_y, lower_z, upper_z;  ///< a byte per child, in steps
};
static_assert(sizeof(BvhNode) == 48);

inline constexpr int least_step_exponent = -100;  ///< of two: 128 such steps are a normal float
TANDEM_HD_INLINE constexpr std::uint32_t frame_exponent(int step_exponent) {
    return static_cast<std::uint32_t>(step_exponent + 7 + 127);
}
TANDEM_HD_INLINE std::uint32_t inner_count(const BvhNode& node) { return node.frame >> 24; }
/// 0 or more: the index of a node; negative: ~entry of a leaf.
TANDEM_HD_INLINE std::int32_t child_of(const BvhNode& node, std::int32_t child) {
    return child < static_cast<std::int32_t>(inner_count(node)) ? node.first_inner + child : node.leaf_base - child;
}

/// A triangle as hit_interval() needs it. Edges are rounded.
struct TriangleEdges {
    Vec3f v0;
    Vec3f e1, e2;  ///< v1 - v0 and v2 - v0
    float size;    ///< |e1|_1 + |e2|_1
};
TANDEM_HD_INLINE TriangleEdges edges_of(const Vec3f& v0, const Vec3f& v1, const Vec3f& v2) {
    const Vec3f e1 = v1 - v0;
    const Vec3f e2 = v2 - v0;
    return {v0, e1, e2, norm1(e1) + norm1(e2)};
}

/// An entry of a hierarchy of triangles alone.
struct alignas(16) EntryTriangle : TriangleEdges {
    std::uint32_t id;
    FaceSides sides;
};
static_assert(sizeof(EntryTriangle) == 48);

inline constexpr std::uint32_t max_bvh_primitives = 1U << 30;
/// The depth limit of build_bvh(). A node leaves three children on the stack at most, so a traversal stack of
/// bvh_stack_size, with an end mark below them, cannot overflow.
inline constexpr int max_bvh_depth = 64;
inline constexpr int bvh_stack_size = (bvh_width - 1) * max_bvh_depth + 1;

}  // namespace tandem
