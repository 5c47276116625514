/// Tests of a ray against the boxes of a node's children, for proposals only. The bound covers the rounding, so speed
/// matters more than the last bit.
///
/// Bound: with q = the step of a node's grid, P = the t of a plane and u = 2^-24, P is computed as (8 + b / 128) a + c
/// with a = 128 q / d and c = (corner - o) / d - 8 a. It errs by 4 u P because of the reciprocal (rough_reciprocal()),
/// which a and c have in common; by 3 u |corner - o| / d because of the difference, the product and the rounding of c,
/// where |corner - o| is at most P d + 255 q; and by u P + 1024 u q / d because of the sums. So by 8 u P and, as a
/// length, by 2^-13 q, which is less than make_node() adds when it rounds planes outward. With the direction and the
/// origin (proposal.h) it errs by 11 u P, so the exit may be too early by 22 u of itself: it grows by `exit_growth`
/// units in the last place, which are at least 32 u of it.
#pragma once

#include <cstring>

#include "tandem/kernel/traversal/bvh.h"
#include "tandem/math/rough.h"
#include "tandem/math/vec.h"

namespace tandem {

/// A query ray in the form that the boxes of nodes need.
struct NodeRay {
    Vec3f origin;
    Vec3f inverse_direction;
};

/// `direction` is a unit vector. A component too small to invert is replaced, which moves the ray inside the scene by
/// less than the least padding of the boxes.
TANDEM_HD_INLINE NodeRay make_node_ray(const Vec3f& origin, const Vec3f& direction) {
    const auto invert = [](float d) {
        return rough_reciprocal(absolute(d) < 1e-18F ? (d < 0.0F ? -1e-18F : 1e-18F) : d);
    };
    return {origin, {invert(direction.x), invert(direction.y), invert(direction.z)}};
}

namespace node_detail {

/// Floats that are not negative are ordered as their bits are; a negative one is below all of these.
TANDEM_HD_INLINE std::int32_t ordered(float a) { return static_cast<std::int32_t>(bits_of(a)); }

TANDEM_HD_INLINE std::int32_t largest_of(std::int32_t a, std::int32_t b, std::int32_t c) {
#if TANDEM_ON_DEVICE
    return __vimax3_s32(a, b, c);
#else
    return a > b ? (a > c ? a : c) : (b > c ? b : c);
#endif
}
TANDEM_HD_INLINE std::int32_t largest_of_0_and(std::int32_t a, std::int32_t b, std::int32_t c) {
#if TANDEM_ON_DEVICE
    return __vimax3_s32_relu(a, b, c);
#else
    const std::int32_t largest = largest_of(a, b, c);
    return largest > 0 ? largest : 0;
#endif
}
/// The lesser of a + b and c.
TANDEM_HD_INLINE std::int32_t least_of_sum_and(std::int32_t a, std::int32_t b, std::int32_t c) {
#if TANDEM_ON_DEVICE
    return __viaddmin_s32(a, b, c);
#else
    const auto sum = static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
    return sum < c ? sum : c;
#endif
}
TANDEM_HD_INLINE std::int32_t least_of(std::int32_t a, std::int32_t b, std::int32_t c) {
#if TANDEM_ON_DEVICE
    return __vimin3_s32(a, b, c);
#else
    return a < b ? (a < c ? a : c) : (b < c ? b : c);
#endif
}

/// 8 + b / 128, where b is the byte of `child`. `bits_of_8`: see BvhView. On the GPU one permutation of bytes makes two
/// halves, and the unit for floating-point multiplication converts these to float; the unit that permutes and compares
/// is the busiest (docs/performance/hierarchies.md).
TANDEM_HD_INLINE float plane_of(std::uint32_t bytes, std::uint32_t child, std::uint32_t bits_of_8) {
#if TANDEM_ON_DEVICE
    const std::uint32_t halves = __byte_perm(bytes, bits_of_8, child < 2 ? 0x5150U : 0x5352U);
    float plane;
    if (child % 2 == 0) {
        asm("{.reg .b16 low, high; mov.b32 {low, high}, %1; cvt.f32.f16 %0, low;}" : "=f"(plane) : "r"(halves));
    } else {
        asm("{.reg .b16 low, high; mov.b32 {low, high}, %1; cvt.f32.f16 %0, high;}" : "=f"(plane) : "r"(halves));
    }
    return plane;
#else
    const std::uint32_t half = bits_of_8 | (bytes >> (8 * child) & 255U);
    return float_of((half << 13) + 0x38000000U);  // the same number as a float: 13 more bits, a bias greater by 112
#endif
}

/// The float whose exponent is byte `axis` of a frame: 128 steps.
TANDEM_HD_INLINE float steps_of(std::uint32_t frame, int axis) {
    return float_of((axis == 0 ? frame << 23 : axis == 1 ? frame << 15 : frame << 7) & 0x7F800000U);
}

}  // namespace node_detail

/// By how much the exit from a box grows, in units in the last place.
inline constexpr std::int32_t exit_growth = 32;

/// A child that the ray does not enter, and the end of a traversal.
inline constexpr std::int32_t no_child = 0x7FFFFFFF;

/// The children that a ray enters within [start, limit], by the distance of the entry: keys in order, then no_child.
/// The two low bits of a key are the child.
struct EnteredChildren {
    std::int32_t key[bvh_width];
};

/// `starts_late`: whether `start` may be positive.
template <bool starts_late>
TANDEM_HD_INLINE EnteredChildren enter_children(const BvhNode& node, std::uint32_t bits_of_8, const NodeRay& ray,
                                                float start, float limit) {
    using namespace node_detail;
    struct Slab {
        float scale, offset;
        std::uint32_t near, far;
    };
    const auto slab = [&](int axis, float origin, float inverse, std::uint32_t lower, std::uint32_t upper) {
        const float scale = steps_of(node.frame, axis) * inverse;
        const float offset = loose_multiply_add(-8.0F, scale, (node.corner[axis] - origin) * inverse);
        return Slab{scale, offset, inverse < 0.0F ? upper : lower, inverse < 0.0F ? lower : upper};
    };
    const Slab x = slab(0, ray.origin.x, ray.inverse_direction.x, node.lower_x, node.upper_x);
    const Slab y = slab(1, ray.origin.y, ray.inverse_direction.y, node.lower_y, node.upper_y);
    const Slab z = slab(2, ray.origin.z, ray.inverse_direction.z, node.lower_z, node.upper_z);
    EnteredChildren entered;
#if TANDEM_ON_DEVICE
#pragma unroll
#endif
    for (std::uint32_t i = 0; i < bvh_width; ++i) {
        const auto at = [&](const Slab& s, std::uint32_t planes) {
            return ordered(loose_multiply_add(plane_of(planes, i, bits_of_8), s.scale, s.offset));
        };
        std::int32_t entry = largest_of_0_and(at(x, x.near), at(y, y.near), at(z, z.near));
        if (starts_late) entry = entry > ordered(start) ? entry : ordered(start);
        const std::int32_t farthest = least_of(at(x, x.far), at(y, y.far), at(z, z.far));
        const std::int32_t exit = least_of_sum_and(farthest, exit_growth, ordered(limit));
        entered.key[i] = entry <= exit ? (entry & ~3) | static_cast<std::int32_t>(i) : no_child;
    }
    const auto order = [&](int i, int j) {
        const std::int32_t a = entered.key[i], b = entered.key[j];
        entered.key[i] = a < b ? a : b;
        entered.key[j] = a < b ? b : a;
    };
    order(0, 1);
    order(2, 3);
    order(0, 2);
    order(1, 3);
    order(1, 2);
    return entered;
}

}  // namespace tandem
