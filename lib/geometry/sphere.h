/// The sphere.
#pragma once

#include "tandem/geometry/crossing.h"
#include "tandem/math/aabb.h"
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

/// Both crossings of a line with a sphere.
///
/// Needs: `offset` = origin - centre and `direction`, of any length but zero; float values within coordinate_limit,
///        widened, so that the subtraction is exact or errs by 2^-53.
/// Gives: t within 1 ulp of float after rounding, and the right decision between hit and miss, for every case of
///        docs/numerics.md, sphere. A tangent line crosses (closed ball). NaN in any input: no crossing.
/// Method: the discriminant is r^2 - |perpendicular|^2, with the perpendicular from the centre to the line formed
///         before it is squared, and the root of larger magnitude first. The textbook b^2 - ac cancels.
/// Source: E. Haines, J. Guenther, T. Akenine-Moeller, "Precision Improvements for Ray/Sphere Intersection", Ray
///         Tracing Gems ch. 7; evaluated in double. Bound held by tests/unit/geometry/sphere_test.cpp.
template <class Real>
TANDEM_HD Crossing<Real> cross_sphere(const Vec3<Double<Real>>& offset, const Vec3<Double<Real>>& direction,
                                      const Double<Real>& radius) {
    using D = Double<Real>;
    const D zero(0.0);
    const D a = dot(direction, direction);
    const D b = -dot(offset, direction);
    const D foot = b / a;
    const Vec3<D> perpendicular = {offset.x + foot * direction.x, offset.y + foot * direction.y,
                                   offset.z + foot * direction.z};
    const D radius2 = radius * radius;
    const D discriminant = radius2 - dot(perpendicular, perpendicular);
    const Mask<Real> crosses = discriminant >= zero;
    const D root = square_root(a * select(crosses, discriminant, zero));
    const D q = b + select(b < zero, -root, root);
    const D c = dot(offset, offset) - radius2;
    // q = 0 only for b = 0 and a tangent or empty line; both crossings are then at t = 0
    const D t_small = select(q == zero, zero, c / q);
    const D t_large = q / a;
    return {crosses, lesser(t_small, t_large), greater(t_small, t_large)};
}

template <class Real>
TANDEM_HD Crossing<Real> cross_sphere(const Sphere& sphere, const Ray<Real>& ray) {
    using D = Double<Real>;
    return cross_sphere<Real>(widen(ray.origin) - broadcast<D>(widen(sphere.centre)), widen(ray.direction),
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
