/// The sphere.
#pragma once

#include "tandem/geometry/crossing.h"
#include "tandem/math/aabb.h"
#include "tandem/math/ray.h"

namespace tandem {

/// World space, metres, radius > 0. Aligned, so that a GPU reads it in one load.
struct alignas(16) Sphere {
    Vec3f centre;
    float radius;
};

TANDEM_HD Aabb bounds(const Sphere& sphere) {
    const double r = widen(sphere.radius);
    return enclose(widen(sphere.centre), {r, r, r});
}

/// What decides about a line and a sphere: with b = -offset . direction, the roots of a t^2 - 2 b t + c are q / a and
/// c / q, where q = b +- sqrt(b^2 - a c) takes the sign that does not cancel.
template <class Real>
struct SphereRoots {
    Mask<Real> crosses;
    Double<Real> a, b, c, q;
};

/// Needs: `offset` = origin - centre and `direction`, of any length but zero; float values within coordinate_limit,
///        widened, so that the subtraction is exact or errs by 2^-53.
/// Gives: the right decision between hit and miss except where the distance of the line from the centre is within
///        2^-50 of the radius, relative, and for every case of docs/numerics.md, sphere. A tangent line crosses (closed
///        ball). t within 1 ulp of float after rounding. NaN in any input: no crossing.
/// Method: by Lagrange's identity b^2 - a c = a r^2 - |offset x direction|^2. The moment offset x direction comes
///        from Kahan's differences of products, so nothing cancels, and no division is needed to decide. The textbook
///        b^2 - a c loses everything when the sphere is small and far.
/// Source: the form with the perpendicular is E. Haines, J. Guenther, T. Akenine-Moeller, "Precision Improvements for
///        Ray/Sphere Intersection", Ray Tracing Gems ch. 7; |moment| / |direction| is that perpendicular. Bound held
///        by tests/unit/geometry/sphere_test.cpp.
template <class Real>
TANDEM_HD SphereRoots<Real> sphere_roots(const Vec3<Double<Real>>& offset, const Vec3<Double<Real>>& direction,
                                         const Double<Real>& radius) {
    using D = Double<Real>;
    const D zero(0.0);
    const Vec3<D> moment = accurate_cross(offset, direction);
    const D radius2 = radius * radius;
    SphereRoots<Real> roots;
    roots.a = dot(direction, direction);
    roots.b = -dot(offset, direction);
    roots.c = dot(offset, offset) - radius2;
    const D discriminant = roots.a * radius2 - dot(moment, moment);
    roots.crosses = discriminant >= zero;
    const D root = square_root(select(roots.crosses, discriminant, zero));
    roots.q = roots.b + select(roots.b < zero, -root, root);
    return roots;
}

/// Both crossings.
template <class Real>
TANDEM_HD Crossing<Real> to_crossing(const SphereRoots<Real>& roots) {
    using D = Double<Real>;
    const D zero(0.0);
    // q = 0 only for b = 0 and a tangent or empty line; both crossings are then at t = 0
    const D t_small = select(roots.q == zero, zero, roots.c / roots.q);
    const D t_large = roots.q / roots.a;
    return {roots.crosses, lesser(t_small, t_large), greater(t_small, t_large)};
}

/// first_in_front(to_crossing(roots), t) with one division: from outside (c > 0) the entry is c / q if the sphere is
/// ahead (b > 0), and c / q < 0 if it is behind; from inside the exit is q / a looking past the centre (b >= 0), else
/// c / q. An origin on the surface (c = 0) looking in leaves by q / a; looking out, c / q = 0 is no hit.
template <class Real>
TANDEM_HD Mask<Real> first_in_front(const SphereRoots<Real>& roots, Double<Real>& t) {
    using D = Double<Real>;
    const D zero(0.0);
    const Mask<Real> by_product = roots.c > zero || roots.b < zero;
    t = select(by_product, roots.c, roots.q) / select(by_product, roots.q, roots.a);
    return roots.crosses && t > zero;
}

template <class Real>
TANDEM_HD SphereRoots<Real> sphere_roots(const Sphere& sphere, const Ray<Real>& ray) {
    using D = Double<Real>;
    return sphere_roots<Real>(widen(ray.origin) - broadcast<D>(widen(sphere.centre)), widen(ray.direction),
                              D(widen(sphere.radius)));
}

template <class Real>
TANDEM_HD Crossing<Real> cross_sphere(const Sphere& sphere, const Ray<Real>& ray) {
    return to_crossing(sphere_roots(sphere, ray));
}

/// Unit outward normal at parameter t of the ray, which is on the sphere. Double; normalising the offset from the
/// centre re-projects the point, so the error of t does not tilt the normal.
template <class Real>
TANDEM_HD Vec3<Double<Real>> sphere_normal(const Sphere& sphere, const Ray<Real>& ray, const Double<Real>& t) {
    using D = Double<Real>;
    const Vec3<D> offset = widen(ray.origin) - broadcast<D>(widen(sphere.centre));
    const Vec3<D> direction = widen(ray.direction);
    return normalize(Vec3<D>{offset.x + t * direction.x, offset.y + t * direction.y, offset.z + t * direction.z});
}

}  // namespace tandem
