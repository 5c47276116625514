/// Conservative filters in float: cheap tests that reject only certain misses.
///
/// All but one use `offset x direction`, the Pluecker moment of the ray's line about the centre of the primitive. Its
/// length over |direction| is the distance of the line from the centre, so the test needs neither a division nor a
/// normalised direction. Since only true misses are rejected, filters could differ between machines without changing
/// the image; with IEEE arithmetic they do not.
///
/// Bound: with u = 2^-24 the subtraction origin - centre errs by u |offset| per component and each component of the
/// moment by 3 u (|f_i d_j| + |f_j d_i|); together below 4 u |offset|_1 |direction| as a length. The tests allow
/// filter_margin u (|offset|_1 + |origin|_1). Underflow: products below 2^-149 vanish, so 1e-36 is added where it
/// matters, and directions shorter than 1e-15 pass the sphere's filter, because their squares would be inaccurate. On
/// overflow and NaN the comparison is false and the ray passes. A ray in double (tier precise) is rounded to float
/// first, which adds twice u (|offset|_1 + |origin|_1) |direction|. Tested by tests/kernel/shapes/filter_test.cpp.
///
/// The primitive may differ between lanes: then its numbers are of type Float<Real>, else floats.
/// Source of the sphere test: E. Haines, J. Guenther, T. Akenine-Moeller, Ray Tracing Gems ch. 7 (the perpendicular).
#pragma once

#include "tandem/math/ray.h"

namespace tandem {

/// Allowed error per length: 4 u by the bound above, 4 u for the roundings of the squares and of the limit, and half of
/// the sum as a margin.
inline constexpr float filter_margin = 12.0F * float_roundoff;

template <class Real>
TANDEM_HD_INLINE Real loose_dot(const Vec3<Real>& a, const Vec3<Real>& b) {
    return loose_multiply_add(a.z, b.z, loose_multiply_add(a.y, b.y, a.x * b.x));
}

template <class Real>
TANDEM_HD_INLINE Vec3<Real> loose_cross(const Vec3<Real>& a, const Vec3<Real>& b) {
    return {loose_multiply_add(a.y, b.z, -(a.z * b.y)), loose_multiply_add(a.z, b.x, -(a.x * b.z)),
            loose_multiply_add(a.x, b.y, -(a.y * b.x))};
}

/// A ray and what the filters need of it, computed once for all primitives.
template <class Real>
struct FilterRay {
    Ray<Real> ray;
    Float<Real> origin_norm1;
    Float<Real> direction_length2;  ///< infinite for directions too short to be squared in float
};

template <class Real>
TANDEM_HD_INLINE FilterRay<Real> make_filter_ray(const Ray<Real>& ray) {
    using F = Float<Real>;
    const Vec3<F> direction = narrow(ray.direction);
    const F length2 = loose_dot(direction, direction);
    const F infinity(__builtin_huge_valf());
    return {ray, norm1(narrow(ray.origin)), select(length2 < F(1e-30F), infinity, length2)};
}

/// Whether the line of the ray may touch the sphere; false only for certain misses.
template <class Real, class Number = float>
TANDEM_HD_INLINE Mask<Real> may_touch_sphere(const FilterRay<Real>& f, const Vec3<Number>& sphere_centre,
                                             const std::type_identity_t<Number>& radius) {
    using F = Float<Real>;
    const Vec3<F> offset = narrow(f.ray.origin) - broadcast<F>(sphere_centre);
    const Vec3<F> moment = loose_cross(offset, narrow(f.ray.direction));
    const F reach = loose_multiply_add(F(filter_margin), norm1(offset) + f.origin_norm1, F(radius));
    // in this order, because reach^2 alone could underflow
    const F limit = loose_multiply_add(f.direction_length2 * reach, reach, F(1e-36F));
    return !(loose_dot(moment, moment) > limit);
}

/// Whether the sphere is certainly behind the ray: the origin is outside, and the direction points away from the
/// centre. By the bound above offset . direction errs by less than 5 u |offset|_1 |direction|_1, and |offset|^2 by less
/// than 8 u of itself, half of what `reach` adds to radius^2 where the two are close.
template <class Real>
TANDEM_HD_INLINE Mask<Real> is_behind_sphere(const FilterRay<Real>& f, const Vec3f& sphere_centre, float radius) {
    using F = Float<Real>;
    const Vec3<F> direction = narrow(f.ray.direction);
    const Vec3<F> offset = narrow(f.ray.origin) - broadcast<F>(sphere_centre);
    const F size = norm1(offset) + f.origin_norm1;
    const F reach = loose_multiply_add(F(filter_margin), size, F(radius));
    const F slack = loose_multiply_add(F(filter_margin) * size, norm1(direction), F(1e-36F));
    return loose_dot(offset, direction) > slack &&
           loose_dot(offset, offset) > loose_multiply_add(reach, reach, F(1e-36F));
}

/// A box in the form that its filter needs.
struct BoxFilter {
    Vec3f centre;
    Vec3f half;
    float corner_norm1;  ///< |lower|_1 + |upper|_1: the rounding of `centre` and `half` is relative to this
};

TANDEM_HD_INLINE BoxFilter make_box_filter(const Vec3f& lower, const Vec3f& upper) {
    return {(lower + upper) * 0.5F, (upper - lower) * 0.5F, norm1(lower) + norm1(upper)};
}

/// Whether the line of the ray may touch the box. Separating axes of a line and a box: direction x each axis.
template <class Real>
TANDEM_HD_INLINE Mask<Real> may_touch_box(const FilterRay<Real>& f, const BoxFilter& box) {
    using F = Float<Real>;
    const Vec3<F> direction = narrow(f.ray.direction);
    const Vec3<F> offset = narrow(f.ray.origin) - broadcast<F>(box.centre);
    const Vec3<F> moment = loose_cross(offset, direction);
    const Vec3<F> d = {absolute(direction.x), absolute(direction.y), absolute(direction.z)};
    const F slack = loose_multiply_add(F(filter_margin) * (norm1(offset) + f.origin_norm1 + F(box.corner_norm1)),
                                       (d.x + d.y) + d.z, F(1e-36F));
    const auto limit = [&](float h0, const F& d0, float h1, const F& d1) {
        return loose_multiply_add(F(h0), d0, loose_multiply_add(F(h1), d1, slack));
    };
    const F limit_x = limit(box.half.y, d.z, box.half.z, d.y);
    const F limit_y = limit(box.half.z, d.x, box.half.x, d.z);
    const F limit_z = limit(box.half.x, d.y, box.half.y, d.x);
    return !(absolute(moment.x) > limit_x || absolute(moment.y) > limit_y || absolute(moment.z) > limit_z);
}

template <class Real>
TANDEM_HD_INLINE Mask<Real> may_touch_box(const FilterRay<Real>& f, const Vec3f& lower, const Vec3f& upper) {
    return may_touch_box(f, make_box_filter(lower, upper));
}

/// Whether the ray may touch the triangle. False only if its line certainly passes one edge on one side and another on
/// the other side, or if it certainly leads away from the triangle's plane. With a = v0 - origin and the edges e1 = v1
/// - v0, e2 = v2 - v0, two of the volumes are (d x a) . e1 and -(d x a) . e2; all three sum to d . (e1 x e2). The ray
/// leads towards the plane if this sum and a . (e1 x e2) have the same sign.
///
/// Bound: all differences are rounded once, so no volume errs by more than 9 u |d| (|a| + |e|) |e|, |e| = |e1| + |e2|,
/// in 1-norms; the ray's own rounding in the tier precise adds 2 u of that and u |d| |origin| |e|. a . (e1 x e2) has
/// the same error with |a| in place of |d|, plus u (|a| + |origin|) |e|^2 for the rounding of a. The terms with 1e-30
/// keep the limits above the loss by underflow; where a volume overflows, its limit does too.
template <class Real, class Number = float>
TANDEM_HD_INLINE Mask<Real> may_touch_triangle(const FilterRay<Real>& f, const Vec3<Number>& v0, const Vec3<Number>& v1,
                                               const Vec3<Number>& v2) {
    using F = Float<Real>;
    const Vec3<Number> e1 = v1 - v0;
    const Vec3<Number> e2 = v2 - v0;
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
