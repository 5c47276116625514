/// Conservative rejection in float: cheap tests whose only definite answer is "certainly a miss".
///
/// All but one test the line of the ray through `offset x direction`, the Pluecker moment of the line about the centre
/// of the primitive. Its length over |direction| is the distance of the line from the centre, so that no division and
/// no normalised direction is needed. IEEE arithmetic makes the decision the same everywhere; since only true misses
/// are dropped, it could differ without changing the image.
///
/// Bound: with u = 2^-24 the subtraction origin - centre errs by u |offset| per component and each component of
/// the moment by 3 u (|f_i d_j| + |f_j d_i|); together below 4 u |offset|_1 |direction| as a length. The tests allow
/// filter_margin u (|offset|_1 + |origin|_1). Underflow: products below 2^-149 vanish, so 1e-36 is added where it
/// decides, and directions shorter than 1e-15 pass the sphere's filter: their square would lose digits. Overflow and
/// NaN fail the comparison and pass the filter. A ray in double (tier precise) is rounded to float first, which adds
/// u (|offset|_1 + |origin|_1) |direction| twice over. Tested by tests/kernel/shapes/filter_test.cpp.
/// Source of the sphere test: E. Haines, J. Guenther, T. Akenine-Moeller, Ray Tracing Gems ch. 7 (the perpendicular).
#pragma once

#include "tandem/math/ray.h"

namespace tandem {

/// Allowed error per length: 4 u by the bound above, 4 u for the roundings of the squares and of the limit, and half of
/// that again as a margin.
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
    Float<Real> origin_norm1;
    Float<Real> direction_length2;  ///< infinite for directions too short to be squared in float
};

template <class Real>
TANDEM_HD FilterRay<Real> make_filter_ray(const Ray<Real>& ray) {
    using F = Float<Real>;
    const Vec3<F> direction = narrow(ray.direction);
    const F length2 = loose_dot(direction, direction);
    const F infinity(__builtin_huge_valf());
    return {ray, norm1(narrow(ray.origin)), select(length2 < F(1e-30F), infinity, length2)};
}

/// May the line of the ray touch the sphere? False only if it certainly does not.
template <class Real>
TANDEM_HD Mask<Real> may_touch_sphere(const FilterRay<Real>& f, const Vec3f& sphere_centre, float radius) {
    using F = Float<Real>;
    const Vec3<F> offset = narrow(f.ray.origin) - broadcast<F>(sphere_centre);
    const Vec3<F> moment = loose_cross(offset, narrow(f.ray.direction));
    const F reach = loose_multiply_add(F(filter_margin), norm1(offset) + f.origin_norm1, F(radius));
    // in this order: reach^2 could underflow before the length makes up for it
    const F limit = loose_multiply_add(f.direction_length2 * reach, reach, F(1e-36F));
    return !(loose_dot(moment, moment) > limit);
}

/// Is the sphere certainly behind the ray, which starts outside of it and leads away from its centre? By the bound
/// above offset . direction errs by less than 5 u |offset|_1 |direction|_1, and |offset|^2 by less than 8 u of itself,
/// half of what the reach adds to radius^2 where the two are near each other.
template <class Real>
TANDEM_HD Mask<Real> is_behind_sphere(const FilterRay<Real>& f, const Vec3f& sphere_centre, float radius) {
    using F = Float<Real>;
    const Vec3<F> direction = narrow(f.ray.direction);
    const Vec3<F> offset = narrow(f.ray.origin) - broadcast<F>(sphere_centre);
    const F size = norm1(offset) + f.origin_norm1;
    const F reach = loose_multiply_add(F(filter_margin), size, F(radius));
    const F slack = loose_multiply_add(F(filter_margin) * size, norm1(direction), F(1e-36F));
    return loose_dot(offset, direction) > slack &&
           loose_dot(offset, offset) > loose_multiply_add(reach, reach, F(1e-36F));
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
    using F = Float<Real>;
    const Vec3<F> direction = narrow(f.ray.direction);
    const Vec3<F> offset = narrow(f.ray.origin) - broadcast<F>(box.centre);
    const Vec3<F> moment = loose_cross(offset, direction);
    const Vec3<F> d = {absolute(direction.x), absolute(direction.y), absolute(direction.z)};
    const F slack = loose_multiply_add(F(filter_margin) * (norm1(offset) + f.origin_norm1 + F(box.corner_norm1)),
                                       (d.x + d.y) + d.z, F(1e-36F));
    const auto limit = [&](float h0, const F& d0, float h1, const F& d1) TANDEM_INLINE_LAMBDA {
        return loose_multiply_add(F(h0), d0, loose_multiply_add(F(h1), d1, slack));
    };
    const F limit_x = limit(box.half.y, d.z, box.half.z, d.y);
    const F limit_y = limit(box.half.z, d.x, box.half.x, d.z);
    const F limit_z = limit(box.half.x, d.y, box.half.y, d.x);
    return !(absolute(moment.x) > limit_x || absolute(moment.y) > limit_y || absolute(moment.z) > limit_z);
}

template <class Real>
TANDEM_HD Mask<Real> may_touch_box(const FilterRay<Real>& f, const Vec3f& lower, const Vec3f& upper) {
    return may_touch_box(f, make_box_filter(lower, upper));
}

/// May the ray touch the triangle? False only if its line passes one edge certainly on one side and another certainly
/// on the other, or if it certainly leads away from the triangle's plane. With a = v0 - origin and the edges e1 = v1 -
/// v0, e2 = v2 - v0, the volumes that say so are (d x a) . e1, -(d x a) . e2 and, as their sum with the one that is
/// left, d . (e1 x e2); the ray leads to the plane where that and a . (e1 x e2) have one sign.
///
/// Bound: all differences are rounded once, so no volume errs by more than 9 u |d| (|a| + |e|) |e|, |e| = |e1| + |e2|,
/// in 1-norms; the ray's own rounding in the tier precise adds 2 u of that and u |d| |origin| |e|. a . (e1 x e2) errs
/// by as much with |a| for |d|, and by u (|a| + |origin|) |e|^2 for the rounding of a. The terms with 1e-30 keep the
/// limits above what underflow takes from products; where a volume overflows, its limit does too.
template <class Real>
TANDEM_HD Mask<Real> may_touch_triangle(const FilterRay<Real>& f, const Vec3f& v0, const Vec3f& v1, const Vec3f& v2) {
    using F = Float<Real>;
    const Vec3f e1 = v1 - v0;
    const Vec3f e2 = v2 - v0;
    const F size(norm1(e1) + norm1(e2));
    const Vec3<F> d = narrow(f.ray.direction);
    const Vec3<F> a = broadcast<F>(v0) - narrow(f.ray.origin);
    const Vec3<F> moment = loose_cross(d, a);
    const F w2 = loose_dot(moment, broadcast<F>(e1));
    const F w1 = -loose_dot(moment, broadcast<F>(e2));
    const Vec3<F> normal = broadcast<F>(loose_cross(e1, e2));
    const F speed = loose_dot(d, normal);
    const F above = loose_dot(a, normal);
    const F w0 = (speed - w1) - w2;
    const F length = norm1(d);
    const F distance = norm1(a) + f.origin_norm1;
    const F reach = loose_multiply_add(length, distance + size, F(1e-30F));
    const F floor = loose_multiply_add(length, F(1e-30F), F(1e-30F));
    const F limit = F(filter_margin) * loose_multiply_add(reach, size, floor);
    const F least = lesser(lesser(w0, w1), w2);
    const F most = greater(greater(w0, w1), w2);
    const F height_floor = loose_multiply_add(distance, F(1e-30F), F(1e-30F));
    const F height_limit = F(filter_margin) * loose_multiply_add(distance * size, size, height_floor);
    const Mask<Real> away = (above > height_limit && speed < -limit) || (above < -height_limit && speed > limit);
    return !(least < -limit && most > limit) && !away;
}

}  // namespace tandem
