/// The sphere.
#pragma once

#include "tandem/kernel/shapes/crossing.h"
#include "tandem/kernel/shapes/hit.h"
#include "tandem/math/aabb.h"
#include "tandem/math/error_free.h"
#include "tandem/math/ray.h"

namespace tandem {

/// World space, metres, radius > 0. Aligned, so that a GPU needs one load.
struct alignas(16) Sphere {
    Vec3f centre;
    float radius;
};

TANDEM_HD_INLINE Aabb bounds(const Sphere& sphere) {
    const double r = widen(sphere.radius);
    return enclose(widen(sphere.centre), {r, r, r});
}

namespace sphere_detail {

/// The coefficients of a t^2 - 2 b t + c = 0 that cancel, and the discriminant b^2 - a c, each rounded only once.
template <class D>
struct Quadratic {
    D discriminant;
    D b;
    D c;
};

/// In pairs of doubles, to 2^-100: for a nearly tangent line and an origin nearly on the sphere. The discriminant is a
/// r^2 - |offset x direction|^2 (Lagrange's identity), which cancels in its last subtraction only.
template <class Real>
TANDEM_HD_CALL Quadratic<Double<Real>> quadratic_in_pairs(Vec3<Double<Real>> origin, Vec3<Double<Real>> centre,
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

/// The coefficients and roots for a line and a sphere: with b = -offset . direction, the roots of a t^2 - 2 b t + c are
/// q / a and c / q, where q = b +- sqrt(b^2 - a c) takes the sign that does not cancel.
template <class Real>
struct SphereRoots {
    Mask<Real> crosses;
    Mask<Real> doubtful;  ///< double did not suffice for these lanes
    Double<Real> a, b, c, q;
};

/// Which lines matter when many are tested at once; only these are evaluated a second time.
template <class Real>
struct SphereLines {
    Mask<Real> active = Mask<Real>(true);
    /// The ray starts on the sphere, and only its far crossing matters. So c is 0 up to rounding, and decides nothing.
    Mask<Real> inward = Mask<Real>(false);
};

/// The roots in double only, from offset = origin - centre; `doubtful` where that may not suffice.
template <class Real>
TANDEM_HD_INLINE SphereRoots<Real> sphere_roots_in_double(const Vec3<Double<Real>>& offset,
                                                          const Vec3<Double<Real>>& direction,
                                                          const Double<Real>& radius, const SphereLines<Real>& lines) {
    using D = Double<Real>;
    const D zero(0.0);
    const Vec3<D> moment = accurate_cross(offset, direction);
    const D offset2 = dot(offset, offset);
    const D radius2 = radius * radius;
    SphereRoots<Real> roots;
    roots.a = dot(direction, direction);
    roots.b = -dot(offset, direction);
    roots.c = offset2 - radius2;
    const D discriminant = roots.a * radius2 - dot(moment, moment);
    roots.crosses = discriminant >= zero;
    const D root = square_root(absolute(discriminant));
    roots.q = roots.b + select(roots.b < zero, -root, root);

    // The discriminant errs by about 2^-50 a |offset| (radius + 2^-50 |offset|), and the roots by that over 2 root q; c
    // errs by 2^-52 of its terms. Doubtful where the sign could be wrong, or a root by 2^-26 of itself.
    const D size2 = offset2 + radius2;
    const D error2 = (roots.a * size2) * (roots.a * multiply_add(D(0x1p-96), offset2, radius2));
    const Mask<Real> touching = discriminant * discriminant <= D(0x1p-94) * error2 ||
                                absolute(discriminant) * (roots.q * roots.q) <= D(0x1p-44) * error2;
    const Mask<Real> on_surface = absolute(roots.c) <= D(0x1p-25) * size2;
    // an inward ray leaves at q / a, unless the centre is behind it
    const Mask<Real> by_quotient = lines.inward && roots.b >= zero;
    roots.doubtful = lines.active && (touching || (on_surface && !by_quotient));
    return roots;
}

/// Needs: direction of any length but zero, radius > 0; magnitudes within coordinate_limit.
/// Gives: the correct decision between hit and miss for float values, widened, unless the sphere is smaller than 2^-90
///        of its distance; t within 1 ulp of float after rounding. A tangent line crosses (closed ball). NaN in any
///        input: no crossing.
/// Method: by Lagrange's identity b^2 - a c = a r^2 - |offset x direction|^2. The moment offset x direction comes from
///         Kahan's differences of products, so no term cancels before the end, and no division is needed to decide; the
///         textbook b^2 - a c loses all digits when the sphere is small and far. Where double may not suffice, the
///         terms are computed again in pairs of doubles; few lines are so nearly tangent, and few origins so near the
///         surface.
/// Source: the form with the perpendicular is E. Haines, J. Guenther, T. Akenine-Moeller, "Precision Improvements for
///        Ray/Sphere Intersection", Ray Tracing Gems ch. 7; |moment| / |direction| is that perpendicular. Bound tested
///        by tests/kernel/shapes/sphere_test.cpp.
template <class Real>
requires(!is_fast<Real>) TANDEM_HD_INLINE SphereRoots<Real> sphere_roots(const Vec3<Double<Real>>& origin,
                                                                         const Vec3<Double<Real>>& centre,
                                                                         const Vec3<Double<Real>>& direction,
                                                                         const Double<Real>& radius,
                                                                         const SphereLines<Real>& lines = {}) {
    using D = Double<Real>;
    const D zero(0.0);
    SphereRoots<Real> roots = sphere_roots_in_double<Real>(origin - centre, direction, radius, lines);
    if (any(roots.doubtful)) [[unlikely]] {
        const auto exact = sphere_detail::quadratic_in_pairs<Real>(origin, centre, direction, radius);
        const D root = square_root(absolute(exact.discriminant));
        roots.crosses = select(roots.doubtful, exact.discriminant >= zero, roots.crosses);
        roots.b = select(roots.doubtful, exact.b, roots.b);
        roots.c = select(roots.doubtful, exact.c, roots.c);
        roots.q = select(roots.doubtful, exact.b + select(exact.b < zero, -root, root), roots.q);
    }
    return roots;
}

/// The same in the tier fast: in float, without a second evaluation.
template <class Real>
requires(is_fast<Real>) TANDEM_HD_INLINE SphereRoots<Real> sphere_roots(const Vec3<Double<Real>>& origin,
                                                                        const Vec3<Double<Real>>& centre,
                                                                        const Vec3<Double<Real>>& direction,
                                                                        const Double<Real>& radius,
                                                                        const SphereLines<Real>& = {}) {
    const Vec3<Real> offset = origin - centre;
    SphereRoots<Real> roots;
    roots.doubtful = Mask<Real>(false);
    roots.a = dot(direction, direction);
    roots.b = -dot(offset, direction);
    const Real to_closest = roots.b / roots.a;
    const Vec3<Real> perpendicular = {offset.x + to_closest * direction.x, offset.y + to_closest * direction.y,
                                      offset.z + to_closest * direction.z};
    const Real radius2 = radius * radius;
    roots.c = dot(offset, offset) - radius2;
    const Real rest = radius2 - dot(perpendicular, perpendicular);
    roots.crosses = rest >= Real(0.0F);
    const Real root = square_root(absolute(rest) * roots.a);
    roots.q = roots.b + select(roots.b < Real(0.0F), -root, root);
    return roots;
}

/// Entry and exit.
template <class Real>
TANDEM_HD_INLINE Crossing<Real> to_crossing(const SphereRoots<Real>& roots) {
    using D = Double<Real>;
    const D zero(0.0);
    // q = 0 only for b = 0 and a tangent or empty line; both crossings are then at t = 0
    const D t_small = select(roots.q == zero, zero, roots.c / roots.q);
    const D t_large = roots.q / roots.a;
    return {roots.crosses, lesser(t_small, t_large), greater(t_small, t_large)};
}

/// The t of first_hit(to_crossing(roots), t) with one division, where the line crosses: from outside (c > 0) the entry
/// is c / q if the sphere is ahead (b > 0), and c / q < 0 if it is behind; from inside the exit is q / a if the centre
/// is ahead (b >= 0), else c / q. From the surface (c = 0) an inward ray leaves at q / a; for an outward one c / q = 0
/// is no hit.
///
/// `inward`: rays that start on the sphere, inward. Their exit does not depend on c. If the line misses the sphere
/// because rounding moved the origin outside, they leave at the point of the line nearest to the sphere.
template <class Real>
TANDEM_HD_INLINE Double<Real> nearest_root(const SphereRoots<Real>& roots, const Mask<Real>& inward) {
    using D = Double<Real>;
    const D zero(0.0);
    const Mask<Real> leads_away = roots.b < zero;
    const Mask<Real> by_product = select(inward, roots.crosses && leads_away, roots.c > zero || leads_away);
    const D dividend = select(inward && !roots.crosses, roots.b, roots.q);
    return select(by_product, roots.c, dividend) / select(by_product, roots.q, roots.a);
}

template <class Real>
TANDEM_HD_INLINE Mask<Real> first_hit(const SphereRoots<Real>& roots, Double<Real>& t) {
    t = nearest_root(roots, Mask<Real>(false));
    return roots.crosses && t > Double<Real>(0.0);
}

template <class Real>
TANDEM_HD_INLINE SphereRoots<Real> sphere_roots(const Sphere& sphere, const Ray<Real>& ray,
                                                const SphereLines<Real>& lines = {}) {
    using D = Double<Real>;
    return sphere_roots<Real>(widen(ray.origin), broadcast<D>(sphere.centre), widen(ray.direction), D(sphere.radius),
                              lines);
}

template <class Real>
TANDEM_HD_INLINE Crossing<Real> cross_sphere(const Sphere& sphere, const Ray<Real>& ray) {
    return to_crossing(sphere_roots(sphere, ray));
}

namespace sphere_detail {

/// first_hit() of the exact roots, infinite for a miss.
template <class Real>
TANDEM_HD_CALL Double<Real> exact_first_hit(Sphere sphere, Ray<Real> ray) {
    Double<Real> t;
    const Mask<Real> hit = first_hit(sphere_roots(sphere, ray), t);
    return select(hit, t, Double<Real>(__builtin_huge_val()));
}

}  // namespace sphere_detail

/// The nearest hit in front of the ray's origin, in the lanes of `active`: first_hit(sphere_roots(sphere, ray),
/// t), with the rare cases out of line.
template <class Real>
requires(!is_fast<Real>) TANDEM_HD_INLINE Mask<Real> first_hit(const Sphere& sphere, const Ray<Real>& ray,
                                                               Double<Real>& t,
                                                               const Mask<Real>& active = Mask<Real>(true)) {
    using D = Double<Real>;
    const SphereRoots<Real> roots = sphere_roots_in_double<Real>(widen(ray.origin) - broadcast<D>(sphere.centre),
                                                                 widen(ray.direction), D(sphere.radius), {active});
    Mask<Real> hit = active && first_hit(roots, t);
    if (any(roots.doubtful)) [[unlikely]] {
        const D exact = sphere_detail::exact_first_hit(sphere, ray);
        hit = select(roots.doubtful, exact < D(__builtin_huge_val()), hit);
        t = select(roots.doubtful, exact, t);
    }
    return hit;
}

template <class Real>
requires(is_fast<Real>) TANDEM_HD_INLINE Mask<Real> first_hit(const Sphere& sphere, const Ray<Real>& ray,
                                                              Double<Real>& t,
                                                              const Mask<Real>& active = Mask<Real>(true)) {
    return active && first_hit(sphere_roots(sphere, ray), t);
}

/// From the centre to the point at parameter t of the ray.
template <class Real>
TANDEM_HD_INLINE Vec3<Double<Real>> sphere_offset(const Sphere& sphere, const Ray<Real>& ray, const Double<Real>& t) {
    using D = Double<Real>;
    const Vec3<D> offset = widen(ray.origin) - broadcast<D>(sphere.centre);
    const Vec3<D> direction = widen(ray.direction);
    return {offset.x + t * direction.x, offset.y + t * direction.y, offset.z + t * direction.z};
}

/// Unit outward normal, in double, at parameter t of the ray, which is on the sphere. Normalising the offset from the
/// centre projects the point onto the sphere, so the error of t does not tilt the normal.
template <class Real>
TANDEM_HD_INLINE Vec3<Double<Real>> sphere_normal(const Sphere& sphere, const Ray<Real>& ray, const Double<Real>& t) {
    return normalize(sphere_offset(sphere, ray, t));
}

/// `exits`: the ray left the sphere inward, so it comes from inside, even if rounding moved its origin outside. For
/// other rays the origin decides, so that a grazing ray enters before it leaves.
template <class Real>
TANDEM_HD_INLINE HitRecord<Real> record_hit(const Sphere& sphere, const Ray<Real>& ray, const Double<Real>&,
                                            const Mask<Real>& exits, const Mask<Real>&) {
    using D = Double<Real>;
    const Vec3<D> start = widen(ray.origin) - broadcast<D>(sphere.centre);
    return {UInt<Real>(0U), exits || dot(start, start) < D(sphere.radius) * D(sphere.radius)};
}

}  // namespace tandem
