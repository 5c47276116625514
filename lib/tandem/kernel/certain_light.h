/// The light of a certain hit, in cheap double precision: either the bits of the general code, or the answer that the
/// bits are not certain.
///
/// Needs: a valid CertainView; a hit that certain_hit() gave for the direction; no effects.
/// Gives: the radiance that advance() gives for the sample in strict, bit for bit, or false.
/// Method: only the cosine of the diffuse lobe and the power of the highlight are rounded to float. Each is bounded
///         from both sides by the errors of this code and of the general code together. The radiance grows with both,
///         so that of the lower bounds and that of the upper bounds enclose the general one. Where these two have the
///         same bits, the general one has them too.
/// Bounds: u = 2^-53, f = origin - centre, r the radius, h half the chord, s the distance along the ray, G = |f|^2 / (h
///         r) >= 1, L the vector to the light, S = `extent`. Each bound is for this code plus the general code; |f|
///         >= 1.15 r gives s <= |f| and b >= |f| / 2.
///         - s: here b errs by 7 u |f| and the discriminant b^2 - c by 15 u |f|^2, so h by 7.5 u |f|^2 / h + 3 u h;
///           there the discriminant errs by 13 u r^2 and c by 5 u |f|^2. Together below 41 u G r; a box: 11 u s.
///         - normal: 23 u G + 21 u G + 12 u; of a box exact.
///         - vector to the light, divided by |L|: (8 u S + 41 u G r) / |L| + 12 u; of a box (19 u S) / |L| + 12 u.
///         - cosine of light and normal: the sum of these and 6 u, below
///           E = u (64 + 64 G + (32 S + 64 G r) / |L|).
///         - highlight 2 (L.N) (N.V) - L.V: twice the errors of both cosines, once that of L.V, below 8 E.
///         - its power n, c^n: n c^(n-1) times that, and the errors of both powers, u (2 n + 256) of c^n.
///         Errors of second order are below a thousandth of these while E < 2^-30.
/// Tested by tests/kernel/certain_light_test.cpp, and on GPUs by tests/agree/film_test.cpp.
#pragma once

#include "tandem/kernel/traversal/certain_hit.h"
#include "tandem/math/fast_math.h"

namespace tandem {

namespace certain_detail {

/// Numbers of the view in the precision of T: double, or FastFloat from what the host rounded.
template <class T, class Exact, class Rough>
TANDEM_HD_INLINE auto in_precision(const Exact& exact, const Rough& rough) {
    if constexpr (std::is_same_v<T, double>) {
        return exact;
    } else if constexpr (std::is_same_v<Rough, Vec3f>) {
        return broadcast<T>(rough);
    } else {
        return T(rough);
    }
}

TANDEM_HD_INLINE double fused(double a, double b, double c) { return multiply_add(a, b, c); }
TANDEM_HD_INLINE FastFloat fused(FastFloat a, FastFloat b, FastFloat c) { return loose_multiply_add(a, b, c); }
template <class T>
TANDEM_HD_INLINE T fused_dot(const Vec3<T>& a, const Vec3<T>& b) {
    return fused(a.z, b.z, fused(a.y, b.y, a.x * b.x));
}
/// a + b s
template <class T>
TANDEM_HD_INLINE Vec3<T> fused_add(const Vec3<T>& a, const Vec3<T>& b, const T& s) {
    return {fused(b.x, s, a.x), fused(b.y, s, a.y), fused(b.z, s, a.z)};
}
TANDEM_HD_INLINE double over(double a) { return close_reciprocal(a); }
TANDEM_HD_INLINE FastFloat over(FastFloat a) { return rough_reciprocal(a.v); }
TANDEM_HD_INLINE double inverse_root_of(double a) { return close_inverse_square_root(a); }
TANDEM_HD_INLINE FastFloat inverse_root_of(FastFloat a) { return rough_inverse_square_root(a.v); }

/// A point on a solid, seen along a unit direction.
template <class T>
struct CertainPoint {
    Vec3<T> normal;
    T s;       ///< distance from the origin of the ray
    T growth;  ///< G, the growth of errors; 0 for a box
    T reach;   ///< G r
};

template <class T>
TANDEM_HD_INLINE CertainPoint<T> point_on(const CertainSphere& sphere, const Vec3<T>& direction) {
    const auto offset = in_precision<T>(sphere.offset, sphere.rough_offset);
    const T b = -fused_dot(offset, direction);
    const T half2 = fused(b, b, -in_precision<T>(sphere.c, sphere.rough_c));
    const T inverse_half = inverse_root_of(half2);
    CertainPoint<T> point;
    point.s = fused(-half2, inverse_half, b);
    point.normal =
        fused_add(offset, direction, point.s) * in_precision<T>(sphere.inverse_radius, sphere.rough_inverse_radius);
    if constexpr (std::is_same_v<T, double>) {
        point.growth = sphere.distance2_per_radius * inverse_half;
        point.reach = point.growth * sphere.radius;
    }
    return point;
}

template <class T>
TANDEM_HD_INLINE CertainPoint<T> point_on(const CertainBox& box, std::uint32_t axis, const Vec3<T>& direction) {
    const auto along = [axis](const auto& a) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; };
    const T zero(0.0);
    const T speed = along(direction);
    const bool forward = speed > zero;
    const T out(forward ? -1.0 : 1.0);
    CertainPoint<T> point;
    point.s = (forward ? along(in_precision<T>(box.lower, box.rough_lower))
                       : along(in_precision<T>(box.upper, box.rough_upper))) *
              over(speed);
    point.normal = {axis == 0 ? out : zero, axis == 1 ? out : zero, axis == 2 ? out : zero};
    point.growth = zero;
    point.reach = zero;
    return point;
}

/// base^n for n = odd 2^squarings and base in [0, 1], within 2 n 2^-53 of itself.
TANDEM_HD_INLINE double whole_power(double base, std::uint32_t odd, std::uint32_t squarings) {
    TANDEM_KEEP_LOOP
    for (; squarings != 0; --squarings) base *= base;
    double power = base;
    TANDEM_KEEP_LOOP
    for (odd >>= 1; odd != 0; odd >>= 1) {
        base *= base;
        if ((odd & 1U) != 0) power *= base;
    }
    return power;
}

/// A weight in float, from below and from above.
struct Weight {
    float low, high;
};
TANDEM_HD_INLINE Weight bounded(double value, double error) {
    return {rough_greater(0.0F, narrow(value - error)), rough_greater(0.0F, narrow(value + error))};
}

/// The cosine of the diffuse lobe and the base of the highlight, at a light.
template <class T>
struct CertainCosines {
    T diffuse, highlight;
    T inverse_distance;  ///< of the light
};

/// `facing`: the cosine of the normal and the direction back along the ray.
template <class T>
TANDEM_HD_INLINE CertainCosines<T> cosines_at(const CertainPoint<T>& point, const CertainLight& light,
                                              const Vec3<T>& along, const T& facing) {
    const Vec3<T> way = fused_add(in_precision<T>(light.offset, light.rough_offset), along, -point.s);
    CertainCosines<T> at;
    at.inverse_distance = inverse_root_of(fused_dot(way, way));
    at.diffuse = fused_dot(point.normal, way) * at.inverse_distance;
    const T towards = -fused_dot(way, along) * at.inverse_distance;
    const T highlight = fused(at.diffuse + at.diffuse, facing, -towards);
    at.highlight = lesser(greater(highlight, T(0.0)), T(1.0));
    return at;
}

template <class T>
TANDEM_HD_INLINE CertainPoint<T> point_at(const CertainView& view, const CertainHit& hit, const Vec3<T>& along) {
    if (hit.slot < CertainView::max_spheres) return point_on(view.spheres[hit.slot], along);
    return point_on(view.boxes[hit.slot - CertainView::max_spheres], hit.axis, along);
}

}  // namespace certain_detail

/// `T`: double, as above; or FastFloat: without bounds, always certain.
template <class T = double, class Real>
TANDEM_HD_INLINE bool certain_light(const CertainView& view, const Vec3f& direction, const CertainHit& hit,
                                    Vec3<Real>& radiance) {
    using namespace certain_detail;
    const Vec3<T> d = {T(direction.x), T(direction.y), T(direction.z)};
    const Vec3<T> along = d * inverse_root_of(fused_dot(d, d));
    const CertainPoint<T> point = point_at(view, hit, along);
    const CertainMaterial& material = view.materials[hit.slot];
    const T facing = -fused_dot(point.normal, along);
    Vec3<Real> low = broadcast<Real>(material.ambient);
    if constexpr (is_fast<T>) {
        TANDEM_KEEP_LOOP
        for (std::uint32_t i = 0; i < view.light_count; ++i) {
            const CertainLight& light = view.lights[i];
            const auto at = cosines_at(point, light, along, facing);
            const T power = tandem::power<T>(at.highlight, T(material.shininess));
            low = low + (broadcast<Real>(material.specular) * power +
                         broadcast<Real>(material.diffuse) * greater(at.diffuse, T(0.0F))) *
                            broadcast<Real>(light.intensity);
        }
        radiance = low;
        return true;
    } else {
        constexpr double u = 0x1p-53;
        Vec3f high = material.ambient;
        bool certain = true;
        TANDEM_KEEP_LOOP
        for (std::uint32_t i = 0; i < view.light_count; ++i) {
            const CertainLight& light = view.lights[i];
            const auto at = cosines_at(point, light, along, facing);
            const double error = u * multiply_add(multiply_add(32.0, view.extent, 64.0 * point.reach),
                                                  at.inverse_distance, multiply_add(64.0, point.growth, 64.0));
            certain = certain && error < 0x1p-30;

            const double power = whole_power(at.highlight, material.odd_part, material.squarings);
            const double n = static_cast<double>(material.shininess);
            const double slope = at.highlight < 0.25 ? material.small_slope : 4.0 * n * power;
            const Weight diffuse = bounded(at.diffuse, error);
            const Weight glossy =
                bounded(power, multiply_add(8.0 * error, slope, u * multiply_add(2.0, n, 256.0) * power));
            low = low + (material.specular * glossy.low + material.diffuse * diffuse.low) * light.intensity;
            high = high + (material.specular * glossy.high + material.diffuse * diffuse.high) * light.intensity;
        }
        radiance = low;
        return certain && low == high;
    }
}

}  // namespace tandem
