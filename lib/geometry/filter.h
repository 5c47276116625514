/// Conservative rejection in float: cheap tests that may only say "certainly a miss".
///
/// All tests look at the line of the ray through `offset x direction`, the Pluecker moment of the line about the
/// centre of the primitive. Its length over |direction| is the distance of the line from the centre, so that no
/// division and no normalised direction is needed. IEEE arithmetic makes the decision the same everywhere; since
/// only true misses are dropped, it could differ and the picture would not.
///
/// Bound: with u = 2^-24 the subtraction origin - centre errs by u |offset| per component and each component of
/// the moment by 3 u (|f_i d_j| + |f_j d_i|); together below 4 u |offset|_1 |direction| as a length. The tests allow
/// filter_margin u (|offset|_1 + |origin|_1). Underflow: products below 2^-149 vanish, so 1e-36 is added where it
/// decides, and directions shorter than 1e-15 pass the sphere's filter: their square would lose digits. Overflow and
/// NaN fail the comparison and pass the filter. Held by tests/unit/geometry/filter_test.cpp.
/// Source of the sphere test: E. Haines, J. Guenther, T. Akenine-Moeller, Ray Tracing Gems ch. 7 (the perpendicular).
#pragma once

#include "tandem/math/ray.h"

namespace tandem {

/// Allowed error per length: 4 u by the bound above, 4 u for the roundings of the squares and of the limit, and half
/// of that again for good measure.
inline constexpr float filter_margin = 12.0F * float_roundoff;

template <class Real>
TANDEM_HD Real loose_dot(const Vec3<Real>& a, const Vec3<Real>& b) {
    return loose_multiply_add(a.z, b.z, loose_multiply_add(a.y, b.y, a.x * b.x));
}

template <class Real>
TANDEM_HD Vec3<Real> loose_cross(const Vec3<Real>& a, const Vec3<Real>& b) {
    return {loose_multiply_add(a.y, b.z, -(a.z * b.y)), loose_multiply_add(a.z, b.x, -(a.x * b.z)),
            loose_multiply_add(a.x, b.y, -(a.y * b.x))};
}

/// What the filters need of a ray, once for all primitives.
template <class Real>
struct FilterRay {
    Ray<Real> ray;
    Real origin_norm1;
    Real direction_length2;  ///< infinite for directions too short to be squared in float
};

template <class Real>
TANDEM_HD FilterRay<Real> make_filter_ray(const Ray<Real>& ray) {
    const Real length2 = loose_dot(ray.direction, ray.direction);
    const Real infinity(__builtin_huge_valf());
    return {ray, norm1(ray.origin), select(length2 < Real(1e-30F), infinity, length2)};
}

/// May the line of the ray touch the sphere? False only if it certainly does not.
template <class Real>
TANDEM_HD Mask<Real> may_touch_sphere(const FilterRay<Real>& f, const Vec3f& sphere_centre, float radius) {
    const Vec3<Real> offset = f.ray.origin - broadcast<Real>(sphere_centre);
    const Vec3<Real> moment = loose_cross(offset, f.ray.direction);
    const Real reach = loose_multiply_add(Real(filter_margin), norm1(offset) + f.origin_norm1, Real(radius));
    // in this order: reach^2 could underflow before the length makes up for it
    const Real limit = loose_multiply_add(f.direction_length2 * reach, reach, Real(1e-36F));
    return !(loose_dot(moment, moment) > limit);
}

/// A box as its filter wants it.
struct BoxFilter {
    Vec3f centre;
    Vec3f half;
    float corner_norm1;  ///< |lower|_1 + |upper|_1: what rounding centre and half is relative to
};

TANDEM_HD BoxFilter make_box_filter(const Vec3f& lower, const Vec3f& upper) {
    return {(lower + upper) * 0.5F, (upper - lower) * 0.5F, norm1(lower) + norm1(upper)};
}

/// May the line of the ray touch the box? Separating axes of a line and a box: direction x each axis.
template <class Real>
TANDEM_HD Mask<Real> may_touch_box(const FilterRay<Real>& f, const BoxFilter& box) {
    const Vec3<Real> offset = f.ray.origin - broadcast<Real>(box.centre);
    const Vec3<Real> moment = loose_cross(offset, f.ray.direction);
    const Vec3<Real> d = {absolute(f.ray.direction.x), absolute(f.ray.direction.y), absolute(f.ray.direction.z)};
    const Real slack =
        loose_multiply_add(Real(filter_margin) * (norm1(offset) + f.origin_norm1 + Real(box.corner_norm1)),
                           (d.x + d.y) + d.z, Real(1e-36F));
    const auto limit = [&](float h0, const Real& d0, float h1, const Real& d1) TANDEM_INLINE_LAMBDA {
        return loose_multiply_add(Real(h0), d0, loose_multiply_add(Real(h1), d1, slack));
    };
    const Real limit_x = limit(box.half.y, d.z, box.half.z, d.y);
    const Real limit_y = limit(box.half.z, d.x, box.half.x, d.z);
    const Real limit_z = limit(box.half.x, d.y, box.half.y, d.x);
    return !(absolute(moment.x) > limit_x || absolute(moment.y) > limit_y || absolute(moment.z) > limit_z);
}

template <class Real>
TANDEM_HD Mask<Real> may_touch_box(const FilterRay<Real>& f, const Vec3f& lower, const Vec3f& upper) {
    return may_touch_box(f, make_box_filter(lower, upper));
}

/// May the line of the ray touch the triangle? False only if it passes one edge certainly on one side and another
/// certainly on the other. With a = v0 - origin and the edges e1 = v1 - v0, e2 = v2 - v0, the volumes that say so are
/// (d x a) . e1, -(d x a) . e2 and, as their sum with the one that is left, d . (e1 x e2).
///
/// Bound: all differences are rounded once, so no volume errs by more than 9 u |d| (|a| + |e|) |e|, |e| = |e1| + |e2|,
/// in 1-norms. The terms with 1e-30 keep the limit above what underflow takes from products; where a volume overflows,
/// the limit does too.
template <class Real>
TANDEM_HD Mask<Real> may_touch_triangle(const FilterRay<Real>& f, const Vec3f& v0, const Vec3f& v1, const Vec3f& v2) {
    const Vec3f e1 = v1 - v0;
    const Vec3f e2 = v2 - v0;
    const float size = norm1(e1) + norm1(e2);
    const Vec3<Real> a = broadcast<Real>(v0) - f.ray.origin;
    const Vec3<Real> moment = loose_cross(f.ray.direction, a);
    const Real w2 = loose_dot(moment, broadcast<Real>(e1));
    const Real w1 = -loose_dot(moment, broadcast<Real>(e2));
    const Real w0 = (loose_dot(f.ray.direction, broadcast<Real>(loose_cross(e1, e2))) - w1) - w2;
    const Real length = norm1(f.ray.direction);
    const Real reach = loose_multiply_add(length, norm1(a) + Real(size), Real(1e-30F));
    const Real floor = loose_multiply_add(length, Real(1e-30F), Real(1e-30F));
    const Real limit = Real(filter_margin) * loose_multiply_add(reach, Real(size), floor);
    const Real least = lesser(lesser(w0, w1), w2);
    const Real most = greater(greater(w0, w1), w2);
    return !(least < -limit && most > limit);
}

}  // namespace tandem
