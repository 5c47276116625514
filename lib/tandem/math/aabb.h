/// Axis-aligned bounding boxes.
#pragma once

#include "tandem/math/error_free.h"
#include "tandem/math/vec.h"

namespace tandem {

/// Closed box [lower, upper]; empty when any lower > upper, as after construction.
struct Aabb {
    Vec3f lower{3.4e38F, 3.4e38F, 3.4e38F};
    Vec3f upper{-3.4e38F, -3.4e38F, -3.4e38F};
};

TANDEM_HD_INLINE Aabb merge(const Aabb& a, const Aabb& b) {
    return {{lesser(a.lower.x, b.lower.x), lesser(a.lower.y, b.lower.y), lesser(a.lower.z, b.lower.z)},
            {greater(a.upper.x, b.upper.x), greater(a.upper.y, b.upper.y), greater(a.upper.z, b.upper.z)}};
}

TANDEM_HD_INLINE bool is_empty(const Aabb& a) {
    return a.lower.x > a.upper.x || a.lower.y > a.upper.y || a.lower.z > a.upper.z;
}

/// Half of the surface area, for the surface area heuristic.
TANDEM_HD_INLINE float half_area(const Aabb& a) {
    const Vec3f extent = a.upper - a.lower;
    return extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
}

/// The same in double, so that it is a number in scenes of any size.
TANDEM_HD_INLINE double wide_half_area(const Aabb& box) {
    const Vec3d extent = widen(box.upper) - widen(box.lower);
    return extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
}

TANDEM_HD_INLINE Vec3f centre(const Aabb& a) { return (a.lower + a.upper) * 0.5F; }

/// Largest magnitude of a coordinate of the box.
TANDEM_HD_INLINE float reach(const Aabb& a) {
    const auto larger = [](float x, float y) { return greater(absolute(x), absolute(y)); };
    return greater(greater(larger(a.lower.x, a.upper.x), larger(a.lower.y, a.upper.y)), larger(a.lower.z, a.upper.z));
}

/// The largest float not above the exact a + b.
TANDEM_HD_INLINE float round_sum_down(double a, double b) {
    const Pair<double> sum = two_sum(a, b);
    if (!(sum.low < 0.0)) return round_down(sum.high);
    // the next double below, so that a float equal to the rounded sum is not returned
    const std::uint64_t bits = bits_of(sum.high);
    return round_down(double_of(sum.high > 0.0 ? bits - 1 : bits + 1));
}
TANDEM_HD_INLINE float round_sum_up(double a, double b) { return -round_sum_down(-a, -b); }

/// The smallest float box around middle +- half_extent, given in double.
TANDEM_HD_INLINE Aabb enclose(const Vec3d& middle, const Vec3d& half_extent) {
    return {{round_sum_down(middle.x, -half_extent.x), round_sum_down(middle.y, -half_extent.y),
             round_sum_down(middle.z, -half_extent.z)},
            {round_sum_up(middle.x, half_extent.x), round_sum_up(middle.y, half_extent.y),
             round_sum_up(middle.z, half_extent.z)}};
}

/// The box moved outward by `margin` on every side, rounded outward.
TANDEM_HD_INLINE Aabb pad(const Aabb& a, float margin) {
    const double m = widen(margin);
    return {{round_sum_down(widen(a.lower.x), -m), round_sum_down(widen(a.lower.y), -m),
             round_sum_down(widen(a.lower.z), -m)},
            {round_sum_up(widen(a.upper.x), m), round_sum_up(widen(a.upper.y), m), round_sum_up(widen(a.upper.z), m)}};
}

}  // namespace tandem
