/// The kernels that cut long, thin primitives before a BVH is built. Included by build_bvh.cu.
///
/// Method: a triangle is cut into two pieces for each primitive that fits along it at the distances that primitives
///         have there, an ellipsoid or parallelepiped into more. They are counted in the cell of the Morton curve
///         around its centre that is as large as its box, so that the result depends on what is near, not on the whole
///         scene. Thick primitives and those along an axis are left alone: pieces do not make their boxes much smaller.
///         Chosen by measurement (docs/performance/hierarchies.md).
/// Source: the idea is that of M. Ernst, G. Greiner, "Early Split Clipping for Bounding Volume Hierarchies", IEEE
///         Symposium on Interactive Ray Tracing, 2007.
#pragma once

#include "cuda/build_tree.h"
#include "cuda/leaf_items.h"

namespace tandem::cuda {

/// The primitives in the order of the curve.
struct SortedPrimitives {
    const std::uint64_t* codes;
    const std::uint32_t* ids;
    std::uint32_t count;
    int first_bit;  ///< of those of a code that they are sorted by

    /// The place of the first one with that code or a higher one.
    [[nodiscard]] __device__ std::uint32_t first_from(std::uint64_t code) const {
        std::uint32_t begin = 0, end = count;
        while (begin < end) {
            const std::uint32_t middle = begin + (end - begin) / 2;
            if (codes[middle] >> first_bit < code >> first_bit) {
                begin = middle + 1;
            } else {
                end = middle;
            }
        }
        return begin;
    }
};

/// How many pieces a primitive in `box` should have: pieces_along() of a box that is `more` times as long.
__device__ inline std::uint32_t pieces_in(const Aabb& box, double more, const SortedPrimitives& sorted,
                                          std::uint32_t place, double cells_per_metre) {
    constexpr int levels = 21;  // of the curve
    const int axis = longest_axis(box);
    const double size = (widen(box.upper[axis]) - widen(box.lower[axis])) * cells_per_metre;
    int level = 0;
    (void)frexp(size, &level);  // a cell of 2^level is as large as the box, but not twice as large
    level = min(max(level, (sorted.first_bit + 2) / 3), levels);
    const std::uint64_t code = sorted.codes[place] >> (3 * level) << (3 * level);
    const std::uint32_t there = sorted.first_from(code + (std::uint64_t{1} << (3 * level))) - sorted.first_from(code);
    return pieces_along(more * ldexp(size, -level), there);
}

__device__ inline std::uint32_t pieces_of(const Triangle& triangle, const SortedPrimitives& sorted, std::uint32_t place,
                                          double cells_per_metre) {
    if (!is_sliver(triangle)) return 1;
    return pieces_in(bounds(triangle), 1, sorted, place, cells_per_metre);
}

__device__ inline std::uint32_t pieces_of(const Placement& solid, const SortedPrimitives& sorted, std::uint32_t place,
                                          double cells_per_metre) {
    constexpr double more = 2;  // four pieces for each primitive that fits along, where a triangle gets two
    if (!is_needle(solid)) return 1;
    const std::uint32_t pieces = pieces_in(bounds(solid), more, sorted, place, cells_per_metre);
    return pieces > 1 && are_small(solid, pieces) ? pieces : 1;
}

/// Low: the pieces of each primitive, in the order of the curve; one more element, for the total.
static __global__ void count_pieces_kernel(SceneView scene, SortedPrimitives sorted, double cells_per_metre,
                                           Counts* sums) {
    const std::uint32_t place = thread_number();
    if (place > sorted.count) return;
    std::uint32_t pieces = 0;
    if (place < sorted.count) {
        pieces = 1;
        visit_primitive(scene, sorted.ids[place], [&]<class Primitive>(const Primitive& primitive) {
            if constexpr (can_have_pieces<Primitive>) {
                pieces = pieces_of(primitive, sorted, place, cells_per_metre);
            }
        });
    }
    sums[place] = counts(0, pieces);
}

/// `sums`: of the pieces before.
static __global__ void pieces_kernel(const std::uint32_t* ids, std::uint32_t count, const Counts* sums, Piece* pieces) {
    const std::uint32_t place = thread_number();
    if (place >= count) return;
    const std::uint32_t begin = low_of(sums[place]), end = low_of(sums[place + 1]);
    for (std::uint32_t i = begin; i < end; ++i) {
        pieces[i] = {ids[place], static_cast<std::uint16_t>(i - begin), static_cast<std::uint16_t>(end - begin)};
    }
}

}  // namespace tandem::cuda
