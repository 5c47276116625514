/// Ellipsoids and parallelepipeds in pieces, as triangles (triangle_pieces.h).
///
/// Bound: the edges come from the inverse of the placement's matrix, in double. For matrices whose condition is less
/// than most_condition, a corner errs by 2^-31 of the solid's size, far less than the padding of every box. Tested by
/// tests/kernel/shapes/body_pieces_test.cpp.
#pragma once

#include <type_traits>

#include "tandem/kernel/shapes/affine.h"
#include "tandem/kernel/shapes/triangle_pieces.h"

namespace tandem {

inline constexpr double most_condition = 0x1p20;

/// Whether there is bounds_within() for such primitives.
template <class Primitive>
inline constexpr bool can_have_pieces = std::is_same_v<Primitive, Triangle> || std::is_base_of_v<Placement, Primitive>;

/// The half edges of the parallelepiped around a solid: the columns.
TANDEM_HD_INLINE Matrix3 half_edges(const Placement& placement) { return inverse(placement.object_from_world); }

/// The product of the matrix's norm and that of its inverse.
TANDEM_HD_INLINE double condition(const Placement& placement) {
    const auto norm = [](const Matrix3& m) {
        const double rows[] = {norm1(m.row[0]), norm1(m.row[1]), norm1(m.row[2])};
        return greater(greater(rows[0], rows[1]), rows[2]);
    };
    return norm(placement.object_from_world) * norm(half_edges(placement));
}

/// Whether one edge is several times as long as both others. The pieces of other shapes have large boxes too.
TANDEM_HD_INLINE bool is_needle(const Placement& placement) {
    constexpr double least2 = 4.0 * 4.0;
    const Matrix3 edges = transpose(half_edges(placement));
    const double a = dot(edges.row[0], edges.row[0]), b = dot(edges.row[1], edges.row[1]),
                 c = dot(edges.row[2], edges.row[2]);
    const double longest = greater(greater(a, b), c);
    const double second = greater(greater(lesser(a, b), lesser(b, c)), lesser(a, c));
    return longest > least2 * second;
}

/// The bounds of the part of the solid in a slab: of the part of the parallelepiped around it. Of a matrix that is too
/// close to singular, those of the whole solid.
TANDEM_HD_INLINE Aabb bounds_within(const Placement& placement, const Slab& slab) {
    const Aabb whole = bounds(placement);
    if (!(condition(placement) < most_condition)) return whole;
    const Matrix3 axes = half_edges(placement);
    const auto corner = [&](int number) {
        const auto side = [number](int axis) { return (number >> axis & 1) != 0 ? 1.0 : -1.0; };
        return placement.centre + axes * Vec3d{side(0), side(1), side(2)};
    };
    constexpr int last = 7;
    Aabb box;
    for (int from = 0; from < last; ++from) {
        for (int axis = 0; axis < 3; ++axis) {
            const int to = from | 1 << axis;
            if (to != from) add_within(corner(from), corner(to), slab, box);
        }
    }
    add_within(corner(last), corner(last), slab, box);  // no edge starts there
    // an ellipsoid's box is smaller
    for (int axis = 0; axis < 3; ++axis) {
        box.lower[axis] = greater(box.lower[axis], whole.lower[axis]);
        box.upper[axis] = lesser(box.upper[axis], whole.upper[axis]);
    }
    return box;
}

/// Whether it pays to cut the solid into `count` pieces: whether their boxes have together less than 0.6 of the area of
/// the whole box.
TANDEM_HD_INLINE bool are_small(const Placement& placement, std::uint32_t count) {
    constexpr double worthwhile = 0.6;
    const Aabb whole = bounds(placement);
    double area = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        area += wide_half_area(bounds_within(placement, slab_of_piece(whole, i, count)));
    }
    return area < worthwhile * wide_half_area(whole);
}

}  // namespace tandem
