/// The sphere.
#pragma once

#include "tandem/geometry/crossing.h"
#include "tandem/math/aabb.h"
#include "tandem/math/error_free.h"
#include "tandem/math/ray.h"

namespace tandem {

/// World space, metres, radius > 0.
struct Sphere {
    Vec3f centre;
    float radius;
};

TANDEM_HD Aabb bounds(const Sphere& sphere) {
    const double r = widen(sphere.radius);
    return enclose(widen(sphere.centre), {r, r, r});
}

namespace sphere_detail {

/// The coefficients of a t^2 - 2 b t + c = 0 that cancel, and the discriminant b^2 - a c, each rounded once.
template <class D>
struct Quadratic {
    D discriminant;
    D b;
    D c;
};

/// In pairs of doubles, to 2^-100: for a line that nearly touches the sphere and an origin that nearly lies on it.
/// The discriminant is a r^2 - |offset x direction|^2 (Lagrange's identity), which does not cancel before its end.
template <class Real>
TANDEM_HD_RARE Quadratic<Double<Real>> quadratic_in_pairs(Vec3<Double<Real>> origin, Vec3<Double<Real>> centre,
                                                          Vec3<Double<Real>> direction, Double<Real> radius) {
    using D = Double<Real>;
    using P = Pair<D>;
    const P fx = two_sum(origin.x, -centre.x);
    const P fy = two_sum(origin.y, -centre.y);
    const P fz = two_sum(origin.z, -centre.z);
    const D zero(0.0);
    const P dx = {direction.x, zero};
    const P dy = {direction.y, zero};
    const P dz = {direction.z, zero};
    const P mx = fy * dz - fz * dy;
    const P my = fz * dx - fx * dz;
    const P mz = fx * dy - fy * dx;
    const P radius2 = two_product(radius, radius);
    const P a = dx * dx + dy * dy + dz * dz;
    const P discriminant = a * radius2 - (mx * mx + my * my + mz * mz);
    const P b = fx * dx + fy * dy + fz * dz;
    const P c = fx * fx + fy * fy + fz * fz - radius2;
    return {discriminant.high, -b.high, c.high};
}

}  // namespace sphere_detail

/// Both crossings of a line with a sphere.
///
/// Needs: direction of any length but zero, radius > 0; magnitudes within coordinate_limit.
/// Gives: the right decision between hit and miss for float values, widened, unless the sphere is smaller than 2^-90
///        of its distance; t within 1 ulp of float after rounding. A tangent line crosses (closed ball). NaN in any
///        input: no crossing.
/// Method: the discriminant is r^2 - |perpendicular|^2, with the perpendicular from the centre to the line formed
///         before it is squared, and the root of larger magnitude first; the textbook b^2 - ac cancels. Where double
///         may not suffice the terms are formed again in pairs of doubles: few lines come so near to touching, and
///         few origins so near to the surface.
/// Source: E. Haines, J. Guenther, T. Akenine-Moeller, "Precision Improvements for Ray/Sphere Intersection", Ray
///         Tracing Gems ch. 7; evaluated in double. Bound held by tests/unit/geometry/sphere_test.cpp.
template <class Real>
TANDEM_HD Crossing<Real> cross_sphere(const Vec3<Double<Real>>& origin, const Vec3<Double<Real>>& centre,
                                      const Vec3<Double<Real>>& direction, const Double<Real>& radius) {
    using D = Double<Real>;
    const D zero(0.0);
    const Vec3<D> offset = origin - centre;
    const D a = dot(direction, direction);
    D b = -dot(offset, direction);
    const D foot = b / a;
    const Vec3<D> perpendicular = {offset.x + foot * direction.x, offset.y + foot * direction.y,
                                   offset.z + foot * direction.z};
    const D offset2 = dot(offset, offset);
    const D radius2 = radius * radius;
    D c = offset2 - radius2;
    const D discriminant = radius2 - dot(perpendicular, perpendicular);
    Mask<Real> crosses = discriminant >= zero;
    D root = square_root(a * absolute(discriminant));
    D q = b + select(b < zero, -root, root);

    // The discriminant errs by about 2^-50 |offset| (radius + 2^-50 |offset|), and the roots by that times
    // a / (2 root q); c errs by 2^-52 of its terms. In doubt where the sign or 2^-26 of a root could be at stake.
    const D size2 = offset2 + radius2;
    const D error2 = size2 * multiply_add(D(0x1p-96), offset2, radius2);
    const Mask<Real> touching = discriminant * discriminant <= D(0x1p-94) * error2 ||
                                absolute(discriminant) * (q * q) <= D(0x1p-44) * a * error2;
    const Mask<Real> doubtful = touching || absolute(c) <= D(0x1p-25) * size2;
    if (any(doubtful)) [[unlikely]] {
        const auto exact = sphere_detail::quadratic_in_pairs<Real>(origin, centre, direction, radius);
        crosses = select(doubtful, exact.discriminant >= zero, crosses);
        root = select(doubtful, square_root(absolute(exact.discriminant)), root);
        b = select(doubtful, exact.b, b);
        c = select(doubtful, exact.c, c);
        q = b + select(b < zero, -root, root);
    }
    // q = 0 only for b = 0 and a tangent or empty line; both crossings are then at t = 0
    const D t_small = select(q == zero, zero, c / q);
    const D t_large = q / a;
    return {crosses, lesser(t_small, t_large), greater(t_small, t_large)};
}

template <class Real>
TANDEM_HD Crossing<Real> cross_sphere(const Sphere& sphere, const Ray<Real>& ray) {
    using D = Double<Real>;
    return cross_sphere<Real>(widen(ray.origin), broadcast<D>(widen(sphere.centre)), widen(ray.direction),
                              D(widen(sphere.radius)));
}

/// Unit outward normal at parameter t of the ray, which is on the sphere. Double: dividing the offset by the radius
/// re-projects the point, so the error of t does not tilt the normal.
template <class Real>
TANDEM_HD Vec3<Double<Real>> sphere_normal(const Sphere& sphere, const Ray<Real>& ray, const Double<Real>& t) {
    using D = Double<Real>;
    const Vec3<D> offset = widen(ray.origin) - broadcast<D>(widen(sphere.centre));
    const Vec3<D> direction = widen(ray.direction);
    return normalize(Vec3<D>{offset.x + t * direction.x, offset.y + t * direction.y, offset.z + t * direction.z});
}

}  // namespace tandem
