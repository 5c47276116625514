/// Triangles in pieces, for acceleration structures: most of the box around a long, thin triangle that lies along no
/// axis is empty. The boxes of its pieces hold the same points, and far less else.
///
/// Bound: the corners of a piece are computed in double and rounded to float, so that a coordinate c of its bounds errs
/// by 2^-25 |c| + 2^-51 S, with S = the largest coordinate of the triangle. The padding of every box is larger
/// (kernel/traversal/proposal.h). Tested by tests/kernel/shapes/triangle_pieces_test.cpp.
#pragma once

#include "tandem/kernel/shapes/triangle.h"
#include "tandem/math/lengths.h"

namespace tandem {

inline constexpr std::uint32_t most_pieces = 16;  ///< of a triangle

/// How many pieces a triangle gets: two for each primitive that fits along it, if a cube around it has `primitives`,
/// and its box is `share` times as long as the cube. The largest whole number up to 2 share cbrt(primitives), without a
/// root.
TANDEM_HD_INLINE std::uint32_t pieces_along(double share, std::uint32_t primitives) {
    const double cube = 8 * (share * share * share) * primitives;
    std::uint32_t pieces = 1;
    while (pieces < most_pieces && static_cast<double>((pieces + 1) * (pieces + 1) * (pieces + 1)) <= cube) ++pieces;
    return pieces;
}

/// What lies between two planes across an axis, in metres; both belong to it.
struct Slab {
    int axis;
    double lower, upper;
};

TANDEM_HD_INLINE int longest_axis(const Aabb& box) {
    const Vec3d extent = widen(box.upper) - widen(box.lower);
    if (extent.x >= extent.y && extent.x >= extent.z) return 0;
    return extent.y >= extent.z ? 1 : 2;
}

/// The slab of piece `number` of `count` of what is in `box`: they are equally thick, and neighbours share a plane.
TANDEM_HD_INLINE Slab slab_of_piece(const Aabb& box, std::uint32_t number, std::uint32_t count) {
    const int axis = longest_axis(box);
    const double lower = widen(box.lower[axis]), upper = widen(box.upper[axis]);
    const auto plane = [&](std::uint32_t i) {
        return i == count ? upper : lower + (upper - lower) * (static_cast<double>(i) / static_cast<double>(count));
    };
    return {axis, plane(number), plane(number + 1)};
}

/// Extends `box` around the part of a segment in a slab.
TANDEM_HD_INLINE void add_within(const Vec3d& p, const Vec3d& q, const Slab& slab, Aabb& box) {
    const auto add = [&](const Vec3d& point) { box = merge(box, Aabb{narrow(point), narrow(point)}); };
    const double start = p[slab.axis], end = q[slab.axis];
    if (slab.lower <= start && start <= slab.upper) add(p);
    const auto cross = [&](double plane) {
        if ((start < plane) != (end < plane)) add(p + (q - p) * ((plane - start) / (end - start)));
    };
    cross(slab.lower);
    cross(slab.upper);
}

/// Whether the box of a triangle, seen along an axis, is much larger than the triangle: then it is long and thin, and
/// lies along no axis.
TANDEM_HD_INLINE bool is_sliver(const Triangle& triangle) {
    constexpr double thick = 8;
    const Aabb box = bounds(triangle);
    const Vec3d normal = cross(widen(triangle.v1) - widen(triangle.v0), widen(triangle.v2) - widen(triangle.v0));
    return wide_half_area(box) > thick * 0.5 * length(normal);
}

/// The bounds of the part of a triangle in a slab; empty if there is none.
TANDEM_HD_INLINE Aabb bounds_within(const Triangle& triangle, const Slab& slab) {
    Aabb box;
    add_within(widen(triangle.v0), widen(triangle.v1), slab, box);
    add_within(widen(triangle.v1), widen(triangle.v2), slab, box);
    add_within(widen(triangle.v2), widen(triangle.v0), slab, box);
    return box;
}

}  // namespace tandem
