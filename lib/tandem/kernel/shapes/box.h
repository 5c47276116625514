/// The axis-aligned box.
#pragma once

#include "tandem/kernel/shapes/crossing.h"
#include "tandem/kernel/shapes/hit.h"
#include "tandem/math/aabb.h"
#include "tandem/math/error_free.h"
#include "tandem/math/ray.h"

namespace tandem {

/// Closed box [lower, upper], lower <= upper; world space, metres. Zero thickness is allowed. Aligned for wide loads.
/// The padding is a member, so that equal boxes have equal bytes.
struct alignas(16) Box {
    Vec3f lower;
    Vec3f upper;
    float unused[2] = {0, 0};
};

TANDEM_HD_INLINE Aabb bounds(const Box& box) { return {box.lower, box.upper}; }

/// Entry and exit of a line through a box, and the axes (0, 1, 2) of the faces where it enters and leaves.
template <class Real>
struct BoxCrossing : Crossing<Real> {
    UInt<Real> near_axis;
    UInt<Real> far_axis;
};

namespace box_detail {

/// Whether the line enters every slab before it leaves any. Compares the quotients exactly: (face - origin) as a pair
/// of doubles, cross-multiplied. Skips axes along which the line does not move.
template <class Real>
TANDEM_HD_CALL Mask<Real> overlaps_in_pairs(Vec3<Double<Real>> lower, Vec3<Double<Real>> upper,
                                            Vec3<Double<Real>> origin, Vec3<Double<Real>> direction) {
    using D = Double<Real>;
    const D zero(0.0);
    const D d[3] = {direction.x, direction.y, direction.z};
    const D o[3] = {origin.x, origin.y, origin.z};
    const D lo[3] = {lower.x, lower.y, lower.z};
    const D hi[3] = {upper.x, upper.y, upper.z};
    Mask<Real> overlaps(true);
    for (int i = 0; i < 3; ++i) {
        const Pair<D> entry = two_sum(select(d[i] > zero, lo[i], hi[i]), -o[i]);
        for (int j = 0; j < 3; ++j) {
            if (i == j) continue;
            const Pair<D> exit = two_sum(select(d[j] > zero, hi[j], lo[j]), -o[j]);
            const Mask<Real> opposed = (d[i] > zero) != (d[j] > zero);
            const D excess = (entry * Pair<D>{d[j], zero} - exit * Pair<D>{d[i], zero}).high;
            const Mask<Real> moves = d[i] != zero && d[j] != zero;
            overlaps = overlaps && (!moves || select(opposed, excess >= zero, excess <= zero));
        }
    }
    return overlaps;
}

}  // namespace box_detail

/// Crossings of a line with the closed box [lower, upper].
///
/// Needs: finite origin and direction, the direction not zero; magnitudes within coordinate_limit.
/// Gives: the correct decision between hit and miss for float values, widened; t within 1 ulp of float after rounding.
///        A line in the plane of a face touches it (closed box). On a tie between axes, after rounding to double, the
///        lowest axis wins. NaN in any input: no crossing.
/// Method: slabs with IEEE division; for an axis along which the line does not move, a test of the origin. Reciprocals,
///         as in b * inv - o * inv, would lose rays at edges and give NaN on faces. Rounding keeps the order of
///         quotients but can make two of them equal, so where entry and exit nearly agree the products decide.
/// Source: T. Kay, J. Kajiya, "Ray Tracing Complex Scenes", 1986; A. Williams et al., "An Efficient and Robust
///         Ray-Box Intersection Algorithm", 2005; evaluated in double. Tested by tests/kernel/shapes/box_test.cpp.
template <class Real>
requires(!is_fast<Real>) TANDEM_HD_CALL_ON(device)
BoxCrossing<Real> cross_box(Vec3<Double<Real>> lower, Vec3<Double<Real>> upper, Vec3<Double<Real>> origin,
                            Vec3<Double<Real>> direction) {
    using D = Double<Real>;
    const D zero(0.0);
    const D infinity(__builtin_huge_val());
    BoxCrossing<Real> result;
    result.crosses = Mask<Real>(true);
    result.t_near = -infinity;
    result.t_far = infinity;
    result.near_axis = UInt<Real>(0U);
    result.far_axis = UInt<Real>(0U);
    const auto slab = [&](const D& lo, const D& hi, const D& o, const D& d, std::uint32_t axis) {
        const Mask<Real> parallel = d == zero;
        const D divisor = select(parallel, D(1.0), d);
        const Mask<Real> forward = d > zero;
        const D entry = select(parallel, -infinity, (select(forward, lo, hi) - o) / divisor);
        const D exit = select(parallel, infinity, (select(forward, hi, lo) - o) / divisor);
        result.crosses = result.crosses && (!parallel || (lo <= o && o <= hi)) && entry <= exit;
        const Mask<Real> later = entry > result.t_near;
        const Mask<Real> sooner = exit < result.t_far;
        result.t_near = select(later, entry, result.t_near);
        result.t_far = select(sooner, exit, result.t_far);
        result.near_axis = select(later, UInt<Real>(axis), result.near_axis);
        result.far_axis = select(sooner, UInt<Real>(axis), result.far_axis);
    };
    slab(lower.x, upper.x, origin.x, direction.x, 0U);
    slab(lower.y, upper.y, origin.y, direction.y, 1U);
    slab(lower.z, upper.z, origin.z, direction.z, 2U);
    const D gap = absolute(result.t_far - result.t_near);
    const Mask<Real> doubtful =
        result.crosses && gap <= D(0x1p-50) * absolute(result.t_far) && result.near_axis != result.far_axis;
    result.crosses = result.crosses && (result.t_near <= result.t_far || doubtful);
    if (any(doubtful)) [[unlikely]] {
        result.crosses =
            result.crosses && (!doubtful || box_detail::overlaps_in_pairs<Real>(lower, upper, origin, direction));
        // rounding may have swapped the two; they are equal then
        result.t_far = greater(result.t_near, result.t_far);
    }
    return result;
}

/// The same in the tier fast: in float, with reciprocals, not exact. A ray in the plane of a face may miss.
template <class Real>
requires(is_fast<Real>) TANDEM_HD_INLINE BoxCrossing<Real> cross_box(const Vec3<Double<Real>>& lower,
                                                                     const Vec3<Double<Real>>& upper,
                                                                     const Vec3<Double<Real>>& origin,
                                                                     const Vec3<Double<Real>>& direction) {
    BoxCrossing<Real> result;
    result.t_near = Real(-__builtin_huge_valf());
    result.t_far = Real(__builtin_huge_valf());
    result.near_axis = UInt<Real>(0U);
    result.far_axis = UInt<Real>(0U);
    const auto slab = [&](const Real& lo, const Real& hi, const Real& o, const Real& d, std::uint32_t axis) {
        const Real inverse = Real(1.0F) / d;
        const Real a = (lo - o) * inverse;
        const Real b = (hi - o) * inverse;
        const Real entry = lesser(a, b);
        const Real exit = greater(a, b);
        const Mask<Real> later = entry > result.t_near;
        const Mask<Real> sooner = exit < result.t_far;
        result.t_near = select(later, entry, result.t_near);
        result.t_far = select(sooner, exit, result.t_far);
        result.near_axis = select(later, UInt<Real>(axis), result.near_axis);
        result.far_axis = select(sooner, UInt<Real>(axis), result.far_axis);
    };
    slab(lower.x, upper.x, origin.x, direction.x, 0U);
    slab(lower.y, upper.y, origin.y, direction.y, 1U);
    slab(lower.z, upper.z, origin.z, direction.z, 2U);
    result.crosses = result.t_near <= result.t_far;
    return result;
}

template <class Real>
TANDEM_HD_INLINE BoxCrossing<Real> cross_box(const Box& box, const Ray<Real>& ray) {
    using D = Double<Real>;
    return cross_box<Real>(broadcast<D>(box.lower), broadcast<D>(box.upper), widen(ray.origin), widen(ray.direction));
}

/// The nearest hit in front of the ray's origin, in the lanes of `active`.
template <class Real>
TANDEM_HD_INLINE Mask<Real> first_hit(const Box& box, const Ray<Real>& ray, Double<Real>& t,
                                      const Mask<Real>& active = Mask<Real>(true)) {
    return active && first_hit<Real>(cross_box(box, ray), t);
}

/// The record of the face that the ray hits first or, in the lanes of `exits`, of the face where it leaves the box.
/// Faces are numbered 2 axis + (1 for the upper one).
template <class Real>
TANDEM_HD_INLINE HitRecord<Real> record_hit(const BoxCrossing<Real>& c, const Vec3<Double<Real>>& direction,
                                            const Mask<Real>& exits) {
    using D = Double<Real>;
    using Word = UInt<Real>;
    const D zero(0.0);
    const Mask<Real> entering = c.t_near > zero && !exits;
    const Word axis = select(entering, c.near_axis, c.far_axis);
    const D along = select(axis == Word(0U), direction.x, select(axis == Word(1U), direction.y, direction.z));
    // the normal points against the ray on entry, along it on exit
    const Mask<Real> against = along < zero;
    const Word upper = select((entering && against) || (!entering && !against), Word(1U), Word(0U));
    return {(axis << 1) | upper, !entering};
}
template <class Real>
TANDEM_HD_INLINE HitRecord<Real> record_hit(const Box& box, const Ray<Real>& ray, const Double<Real>&,
                                            const Mask<Real>& exits, const Mask<Real>&) {
    return record_hit<Real>(cross_box(box, ray), widen(ray.direction), exits);
}

/// Unit outward normal of a face. Axis-aligned and so exact.
template <class Real>
TANDEM_HD_INLINE Vec3<Double<Real>> face_normal(const HitRecord<Real>& record) {
    using D = Double<Real>;
    using Word = UInt<Real>;
    const Word axis = record.part >> 1;
    const D outward = select((record.part & Word(1U)) != Word(0U), D(1.0), D(-1.0));
    const auto component = [&](std::uint32_t a) { return select(axis == Word(a), outward, D(0.0)); };
    return {component(0U), component(1U), component(2U)};
}

}  // namespace tandem
