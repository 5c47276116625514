/// The light of a certain hit, in cheap double precision: the bits of the general code, or the answer that they are
/// not certain.
///
/// Needs: a valid CertainView; a hit that certain_hit() gave for the direction; no effects.
/// Gives: the radiance that advance() gives for the sample in strict, bit for bit, or false.
/// Method: what reaches float is the cosine of the diffuse lobe and the power of the highlight. Each is bounded from
///         both sides by the errors of this code and of the general code together. The radiance grows with both, so
///         that of the lower bounds and that of the upper bounds enclose the general one. Where they have the same
///         bits, so has it.
/// Bounds: u = 2^-53, f = origin - centre, r the radius, h half the chord, s the distance along the ray, G = |f|^2 / (h
///         r) >= 1, L the way to the light, S = `extent`. Each bound is for this code plus the general code; |f|
///         >= 1.15 r gives s <= |f| and b >= |f| / 2.
///         - s: here b errs by 7 u |f| and the discriminant b^2 - c by 15 u |f|^2, so h by 7.5 u |f|^2 / h + 3 u h;
///           there the discriminant errs by 13 u r^2 and c by 5 u |f|^2. Together below 41 u G r; a box: 11 u s.
///         - normal: 23 u G + 21 u G + 12 u; of a box exact.
///         - way to the light, divided by |L|: (8 u S + 41 u G r) / |L| + 12 u; of a box (19 u S) / |L| + 12 u.
///         - cosine of light and normal: the sum of these and 6 u, below
///           E = u (64 + 64 G + (32 S + 64 G r) / |L|).
///         - highlight 2 (L.N) (N.V) - L.V: twice the errors of both cosines, once that of L.V, below 8 E.
///         - its power n, c^n: n c^(n-1) times that, and the errors of both powers, u (2 n + 256) of c^n.
///         Errors of second order are below a thousandth of these while E < 2^-30.
/// Tested by tests/kernel/certain_light_test.cpp, and on GPUs by tests/agree/film_test.cpp.
#pragma once

#include "tandem/kernel/traversal/certain_hit.h"

namespace tandem {

namespace certain_detail {

TANDEM_HD_INLINE double fused_dot(const Vec3d& a, const Vec3d& b) {
    return multiply_add(a.z, b.z, multiply_add(a.y, b.y, a.x * b.x));
}
/// a + b s
TANDEM_HD_INLINE Vec3d fused_add(const Vec3d& a, const Vec3d& b, double s) {
    return {multiply_add(b.x, s, a.x), multiply_add(b.y, s, a.y), multiply_add(b.z, s, a.z)};
}

/// A point on a solid, seen along a unit direction.
struct CertainPoint {
    Vec3d normal;
    double s;       ///< distance from the origin of the ray
    double growth;  ///< G, the growth of errors; 0 for a box
    double reach;   ///< G r
};

TANDEM_HD_INLINE CertainPoint point_on(const CertainSphere& sphere, const Vec3d& direction) {
    const double b = -fused_dot(sphere.offset, direction);
    const double half2 = multiply_add(b, b, -sphere.c);
    const double inverse_half = close_inverse_square_root(half2);
    CertainPoint point;
    point.s = multiply_add(-half2, inverse_half, b);
    point.normal = fused_add(sphere.offset, direction, point.s) * sphere.inverse_radius;
    point.growth = sphere.distance2_per_radius * inverse_half;
    point.reach = point.growth * sphere.radius;
    return point;
}

TANDEM_HD_INLINE CertainPoint point_on(const CertainBox& box, std::uint32_t axis, const Vec3d& direction) {
    const auto along = [axis](const Vec3d& a) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; };
    const double speed = along(direction);
    const bool forward = speed > 0.0;
    const double out = forward ? -1.0 : 1.0;
    CertainPoint point;
    point.s = (forward ? along(box.lower) : along(box.upper)) * close_reciprocal(speed);
    point.normal = {axis == 0 ? out : 0.0, axis == 1 ? out : 0.0, axis == 2 ? out : 0.0};
    point.growth = 0.0;
    point.reach = 0.0;
    return point;
}

/// base^n for n >= 1 and base in [0, 1], within 2 n 2^-53 of itself.
TANDEM_HD_INLINE double whole_power(double base, std::uint32_t n) {
    for (; (n & 1U) == 0; n >>= 1) base *= base;
    double power = base;
    for (n >>= 1; n != 0; n >>= 1) {
        base *= base;
        if ((n & 1U) != 0) power *= base;
    }
    return power;
}

/// A weight in float, from below and from above.
struct Weight {
    float low, high;
};
TANDEM_HD_INLINE Weight bounded(double value, double error) {
    return {narrow(greater(value - error, 0.0)), narrow(greater(value + error, 0.0))};
}

}  // namespace certain_detail

TANDEM_HD_INLINE bool certain_light(const CertainView& view, const Vec3f& direction, const CertainHit& hit,
                                    Vec3f& radiance) {
    using namespace certain_detail;
    constexpr double u = 0x1p-53;
    const Vec3d d = widen(direction);
    const Vec3d along = d * close_inverse_square_root(fused_dot(d, d));
    const CertainPoint point = hit.slot < CertainView::max_spheres
                                   ? point_on(view.spheres[hit.slot], along)
                                   : point_on(view.boxes[hit.slot - CertainView::max_spheres], hit.axis, along);
    const CertainMaterial& material = view.materials[hit.slot];
    const double facing = -fused_dot(point.normal, along);
    Vec3f low = material.ambient, high = material.ambient;
    bool certain = true;
    TANDEM_KEEP_LOOP
    for (std::uint32_t i = 0; i < view.light_count; ++i) {
        const CertainLight& light = view.lights[i];
        const Vec3d way = fused_add(light.offset, along, -point.s);
        const double inverse_distance = close_inverse_square_root(fused_dot(way, way));
        const double cosine = fused_dot(point.normal, way) * inverse_distance;
        const double towards = -fused_dot(way, along) * inverse_distance;
        const double highlight = multiply_add(cosine + cosine, facing, -towards);
        const double error = u * multiply_add(multiply_add(32.0, view.extent, 64.0 * point.reach), inverse_distance,
                                              multiply_add(64.0, point.growth, 64.0));
        certain = certain && error < 0x1p-30;

        const double base = lesser(greater(highlight, 0.0), 1.0);
        const double power = whole_power(base, material.shininess);
        const double n = static_cast<double>(material.shininess);
        const double slope = base < 0.25 ? material.small_slope : 4.0 * n * power;
        const Weight diffuse = bounded(cosine, error);
        const Weight glossy = bounded(power, multiply_add(8.0 * error, slope, u * multiply_add(2.0, n, 256.0) * power));
        low = low + (material.specular * glossy.low + material.diffuse * diffuse.low) * light.intensity;
        high = high + (material.specular * glossy.high + material.diffuse * diffuse.high) * light.intensity;
    }
    radiance = low;
    return certain && low == high;
}

}  // namespace tandem
