/// The triangle.
#pragma once

#include "tandem/kernel/shapes/face_sides.h"
#include "tandem/kernel/shapes/filter.h"
#include "tandem/kernel/shapes/hit.h"
#include "tandem/math/aabb.h"
#include "tandem/math/exact_sum.h"
#include "tandem/math/ray.h"

namespace tandem {

/// The index of a face that has no normals or no texture coordinates.
inline constexpr std::uint32_t no_attributes = 0xFFFFFFFFU;

/// The attributes of a face. Values at its corners are in arrays of the scene, in the order of the corners. There may
/// be several slots of texture coordinates, one after the other, with a pair for each corner.
struct FaceAttributes {
    std::uint32_t normals = no_attributes;    ///< index of the first corner's shading normal
    std::uint32_t texcoords = no_attributes;  ///< index of the first corner's texture coordinates, in slot 0
    FaceSides sides = FaceSides::single_sided;
};

TANDEM_HD_INLINE bool is_double_sided(const FaceAttributes& attributes) {
    return attributes.sides == FaceSides::double_sided;
}

/// World space, metres; counter-clockwise seen from the front. Not degenerate. Aligned, so that a GPU needs three
/// loads.
struct alignas(16) Triangle {
    Vec3f v0, v1, v2;
    FaceAttributes attributes{};
};
static_assert(sizeof(Triangle) == 48, "no byte of a triangle is undefined; scene_hash() reads all");

/// The bounding box of points.
template <class... Points>
TANDEM_HD_INLINE Aabb box_around(const Points&... points) {
    Aabb box;
    ((box = merge(box, Aabb{points, points})), ...);
    return box;
}

TANDEM_HD_INLINE Aabb bounds(const Triangle& triangle) { return box_around(triangle.v0, triangle.v1, triangle.v2); }

/// Barycentric coordinates: the point v0 + u (v1 - v0) + v (v2 - v0); u and v in [0, 1], u + v <= 1.
template <class D>
struct Barycentrics {
    D u, v;
};

// In the functions below, `Number` is the type of a corner's coordinates: float if all lanes have the same triangle,
// Float<Real> if each lane has one of its own. The bits of a lane are the same either way.

/// A coordinate, or another number of a corner, in the precision of decisions.
template <class Real, class Number>
TANDEM_HD_INLINE auto corner_number(const Number& a) {
    if constexpr (std::is_same_v<Number, float>) {
        return Scalar<Double<Real>>(a);
    } else {
        return widen(a);
    }
}
template <class Real, class Number>
TANDEM_HD_INLINE auto corner_point(const Vec3<Number>& v) {
    return Vec3<decltype(corner_number<Real>(v.x))>{corner_number<Real>(v.x), corner_number<Real>(v.y),
                                                    corner_number<Real>(v.z)};
}

namespace triangle_detail {

/// Relative to their bounds: the largest error of the volumes below in double, and the size below which pairs of
/// doubles may not give the right sign, or the nearest double, of a quotient.
inline constexpr double volume_error = 0x1p-49;
inline constexpr double pair_doubt = 0x1p-30;

/// The volumes of a line with the edges of a triangle, in double: d . (p x q) for the edges opposite v0, v1 and v2,
/// with p and q the corners of the edge minus the line's origin. Where the line crosses the triangle, all have one sign
/// or are zero, and they are in proportion to the barycentric coordinates. They come from one moment d x a, as in
/// may_touch_triangle(), and with the same bound.
template <class Real>
struct Volumes {
    using D = Double<Real>;
    D w0, w1, w2;
    D error;
    D speed, above;  ///< d . (e1 x e2), their sum, and a . (e1 x e2): above / speed is t
    D above_error;

    template <class Number>
    TANDEM_HD_INLINE Volumes(const Vec3<Number>& v0, const Vec3<Number>& v1, const Vec3<Number>& v2,
                             const Ray<Real>& ray) {
        const auto p0 = corner_point<Real>(v0);
        const auto e1 = corner_point<Real>(v1) - p0;
        const auto e2 = corner_point<Real>(v2) - p0;
        const auto size = norm1(e1) + norm1(e2);
        const Vec3<D> d = widen(ray.direction);
        const Vec3<D> a = broadcast<D>(p0) - widen(ray.origin);
        const Vec3<D> moment = accurate_cross(d, a);
        w2 = dot(moment, broadcast<D>(e1));
        w1 = -dot(moment, broadcast<D>(e2));
        const Vec3<D> normal = broadcast<D>(accurate_cross(e1, e2));
        speed = dot(d, normal);
        above = dot(a, normal);
        w0 = (speed - w1) - w2;
        const D reach = norm1(a) + D(size);
        error = D(volume_error) * ((norm1(d) * reach) * D(size));
        above_error = D(volume_error) * ((reach * D(size)) * D(size));
    }

    /// Whether a crossing is certainly behind the origin or beyond `farthest`.
    [[nodiscard]] TANDEM_HD_INLINE Mask<Real> is_out_of_reach(const D& farthest) const {
        const Mask<Real> turned = speed < D(0.0);
        const D height = select(turned, -above, above);
        const D most = (absolute(speed) + error) * D(1.0 + 0x1p-40);
        return height < -above_error || height - above_error > farthest * most;
    }
};

/// The crossing of a line with a triangle, in float, for the tier fast.
/// Source: T. Moeller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", JGT 2(1), 1997.
template <class Real>
struct RoughCrossing {
    Real t;
    Barycentrics<Real> at;

    template <class Number>
    TANDEM_HD_INLINE RoughCrossing(const Vec3<Number>& v0, const Vec3<Number>& v1, const Vec3<Number>& v2,
                                   const Ray<Real>& ray) {
        const Vec3<Real> e1 = broadcast<Real>(v1 - v0);
        const Vec3<Real> e2 = broadcast<Real>(v2 - v0);
        const Vec3<Real> p = cross(ray.direction, e2);
        const Vec3<Real> from = ray.origin - broadcast<Real>(v0);
        const Vec3<Real> q = cross(from, e1);
        const Real inverse = Real(1.0F) / dot(e1, p);
        at = {dot(from, p) * inverse, dot(ray.direction, q) * inverse};
        t = dot(e2, q) * inverse;
    }
};

/// a - b exactly, by component.
template <class D>
TANDEM_HD_INLINE Vec3<Pair<D>> subtract(const Vec3<D>& a, const Vec3<D>& b) {
    return {two_sum(a.x, -b.x), two_sum(a.y, -b.y), two_sum(a.z, -b.z)};
}
template <class D>
TANDEM_HD_INLINE D size_of(const Vec3<Pair<D>>& a) {
    return (absolute(a.x.high) + absolute(a.y.high)) + absolute(a.z.high);
}
template <class D, class Scalar>
TANDEM_HD_INLINE Vec3<Pair<D>> broadcast_pairs(const Vec3<Pair<Scalar>>& a) {
    return {Pair<D>{D(a.x.high), D(a.x.low)}, Pair<D>{D(a.y.high), D(a.y.low)}, Pair<D>{D(a.z.high), D(a.z.low)}};
}

/// The crossing of a line with the plane of a triangle, in pairs of doubles.
template <class Real>
struct PlaneCrossing {
    using D = Double<Real>;
    D t;
    Mask<Real> in_front;
    Mask<Real> doubtful;  ///< pairs did not suffice for these lanes

    template <class Number>
    TANDEM_HD_INLINE PlaneCrossing(const Vec3<Number>& v0, const Vec3<Number>& v1, const Vec3<Number>& v2,
                                   const Ray<Real>& ray) {
        const auto p0 = corner_point<Real>(v0);
        const auto e1 = subtract(corner_point<Real>(v1), p0);
        const auto e2 = subtract(corner_point<Real>(v2), p0);
        const Vec3<Pair<D>> normal = broadcast_pairs<D>(cross(e1, e2));
        const D area(size_of(e1) * size_of(e2));
        const Vec3<Pair<D>> a = subtract(broadcast<D>(p0), widen(ray.origin));
        const Vec3<D> d = widen(ray.direction);
        const D zero(0.0);
        const Pair<D> above = dot(a, normal);
        const Pair<D> speed = dot(Vec3<Pair<D>>{Pair<D>{d.x, zero}, Pair<D>{d.y, zero}, Pair<D>{d.z, zero}}, normal);
        t = quotient(above, speed);
        in_front = !((above.high > zero) != (speed.high > zero));
        doubtful = absolute(above.high) <= D(pair_doubt) * (size_of(a) * area) ||
                   absolute(speed.high) <= D(pair_doubt) * (norm1(d) * area);
    }
};

/// The same, and the volumes, without rounding, for one ray. `T` is its scalar.
template <class T>
class ExactCrossing {
  public:
    TANDEM_HD_INLINE ExactCrossing(const Vec3f& v0, const Vec3f& v1, const Vec3f& v2, const Ray<T>& ray)
        : v_{Vec3<T>(v0), Vec3<T>(v1), Vec3<T>(v2)}, ray_(ray) {}

    /// The parameter of the hit, or infinity for a miss.
    TANDEM_HD_INLINE double parameter() const {
        const double miss = __builtin_huge_val();
        const ExactSum<T> speed = volume();
        const int front = speed.sign();
        if (front == 0) return miss;
        TANDEM_KEEP_LOOP
        for (int corner = 0; corner < 3; ++corner) {
            if (weight(corner).sign() == -front) return miss;
        }
        ExactSum<T> above;  // det(v0 - o, v1 - o, v2 - o)
        add_determinant(above, v_[0], v_[1], v_[2]);
        add_determinant(above, ray_.origin, v_[1], v_[2], true);
        add_determinant(above, v_[0], ray_.origin, v_[2], true);
        add_determinant(above, v_[0], v_[1], ray_.origin, true);
        if (above.sign() != front) return miss;
        return quotient(above.leading(), speed.leading());
    }

    /// For a line that crosses the triangle.
    TANDEM_HD_INLINE Barycentrics<double> barycentrics() const {
        const ScaledPair whole = volume().leading();
        if (whole.mantissa.high == 0.0) return {0.0, 0.0};
        return {quotient(weight(1).leading(), whole), quotient(weight(2).leading(), whole)};
    }

  private:
    /// det(d, p - o, q - o) for the edge p, q opposite a corner.
    TANDEM_HD_INLINE ExactSum<T> weight(int corner) const {
        const Vec3<T>& p = v_[(corner + 1) % 3];
        const Vec3<T>& q = v_[(corner + 2) % 3];
        ExactSum<T> sum;
        add_determinant(sum, ray_.direction, p, q);
        add_determinant(sum, ray_.direction, ray_.origin, q, true);
        add_determinant(sum, ray_.direction, p, ray_.origin, true);
        return sum;
    }

    /// Their sum, in which the origin cancels: det(d, v1 - v0, v2 - v0).
    TANDEM_HD_INLINE ExactSum<T> volume() const {
        ExactSum<T> sum;
        TANDEM_KEEP_LOOP
        for (int i = 0; i < 3; ++i) add_determinant(sum, ray_.direction, v_[i], v_[(i + 1) % 3]);
        return sum;
    }

    Vec3<T> v_[3];
    Ray<T> ray_;
};

template <class T>
TANDEM_HD_CALL double exact_parameter(Vec3f v0, Vec3f v1, Vec3f v2, Ray<T> ray) {
    return ExactCrossing<T>(v0, v1, v2, ray).parameter();
}
template <class T>
TANDEM_HD_CALL Barycentrics<double> exact_barycentrics(Vec3f v0, Vec3f v1, Vec3f v2, Ray<T> ray) {
    return ExactCrossing<T>(v0, v1, v2, ray).barycentrics();
}

template <class Number>
TANDEM_HD_INLINE Vec3f one_corner(const Vec3<Number>& v, int i) {
    return {lane(v.x, i), lane(v.y, i), lane(v.z, i)};
}
#if !TANDEM_ON_DEVICE
// g++ would keep a copy of every corner in memory until the call (docs/performance/before-and-after.md)
TANDEM_HD_INLINE const Vec3f& one_corner(const Vec3f& v, int) { return v; }
#endif
template <class Real>
TANDEM_HD_INLINE Ray<Scalar<Real>> one_ray(const Ray<Real>& ray, int i) {
    const Vec3<Real>&o = ray.origin, &d = ray.direction;
    return {{lane(o.x, i), lane(o.y, i), lane(o.z, i)}, {lane(d.x, i), lane(d.y, i), lane(d.z, i)}};
}

/// The parameter of the hit, or infinity for a miss, in the lanes of `active`; others are not evaluated a second time.
/// A hit beyond `farthest` may count as a miss.
template <class Real, class Number>
requires(!is_fast<Real>) TANDEM_HD_CALL Double<Real> parameter(Vec3<Number> v0, Vec3<Number> v1, Vec3<Number> v2,
                                                               Ray<Real> ray, Mask<Real> active,
                                                               Double<Real> farthest) {
    using D = Double<Real>;
    const Volumes<Real> w(v0, v1, v2, ray);
    const D least = lesser(lesser(w.w0, w.w1), w.w2);
    const D most = greater(greater(w.w0, w.w1), w.w2);
    Mask<Real> inside = least > w.error || most < -w.error;
    Mask<Real> doubtful = !inside && (least >= -w.error || most <= w.error);
    inside = inside && active && !w.is_out_of_reach(farthest);
    D t(__builtin_huge_val());
    if (any(inside)) {
        const PlaneCrossing<Real> plane(v0, v1, v2, ray);
        t = select(inside && plane.in_front && !plane.doubtful, plane.t, t);
        doubtful = doubtful || (inside && plane.doubtful);
    }
    doubtful = doubtful && active;
    if (any(doubtful)) [[unlikely]] {
        for (int i = 0; i < RealTraits<Real>::lanes; ++i) {
            if (!lane(doubtful, i)) continue;
            set_lane(t, i, exact_parameter(one_corner(v0, i), one_corner(v1, i), one_corner(v2, i), one_ray(ray, i)));
        }
    }
    return t;
}

/// The same in the tier fast: in float, not watertight. A line through an edge may miss both of its triangles.
template <class Real, class Number>
requires(is_fast<Real>) TANDEM_HD_INLINE Real
    parameter(const Vec3<Number>& v0, const Vec3<Number>& v1, const Vec3<Number>& v2, const Ray<Real>& ray,
              const Mask<Real>&, const Real&) {
    const RoughCrossing<Real> crossing(v0, v1, v2, ray);
    const Real zero(0.0F);
    const Mask<Real> inside =
        crossing.at.u >= zero && crossing.at.v >= zero && crossing.at.u + crossing.at.v <= Real(1.0F);
    return select(inside, crossing.t, Real(__builtin_huge_valf()));
}

/// In the lanes of `active`, within 2^-22; they may be out of range by as much.
template <class Real, class Number>
TANDEM_HD_INLINE Barycentrics<Double<Real>> fine_barycentrics(const Vec3<Number>& v0, const Vec3<Number>& v1,
                                                              const Vec3<Number>& v2, const Ray<Real>& ray,
                                                              const Mask<Real>& active) {
    using D = Double<Real>;
    const Volumes<Real> w(v0, v1, v2, ray);
    const D whole = (w.w0 + w.w1) + w.w2;
    Barycentrics<D> at = {w.w1 / whole, w.w2 / whole};
    const Mask<Real> coarse = active && w.error > D(0x1p-24) * absolute(whole);
    if (any(coarse)) [[unlikely]] {
        for (int i = 0; i < RealTraits<Real>::lanes; ++i) {
            if (!lane(coarse, i)) continue;
            const auto exact =
                exact_barycentrics(one_corner(v0, i), one_corner(v1, i), one_corner(v2, i), one_ray(ray, i));
            set_lane(at.u, i, exact.u);
            set_lane(at.v, i, exact.v);
        }
    }
    return at;
}

}  // namespace triangle_detail

/// The hit of a ray on the closed triangle (v0, v1, v2) in front of its origin, in the lanes of `active`; `t` is valid
/// where the result is true. A hit beyond `farthest` may be omitted, to save time.
///
/// Needs: finite vertices, a traceable ray (is_traceable()).
/// Gives: always the correct decision between hit and miss, in the tiers strict and precise: triangles that share an
///        edge or a vertex are watertight. A line through an edge or a vertex hits, with either winding; a line in the
///        plane misses, and so does every line if the triangle is degenerate. t is the double nearest to the exact
///        quotient, except within 2^-16 ulp of a midpoint between two doubles. So triangles that a line hits in the
///        same point give the same t, and the lower id wins. NaN in any input: no hit.
/// Method: the signs of the three volumes between the line and the edges, which are equal and opposite for the two
///         triangles at an edge. They are computed in double, with differences of products that do not cancel, and
///         exactly where a sign is within its error of zero; so is the sign of t. This needs no shear and no
///         reciprocal. t comes from the plane, in pairs of doubles. In double alone it would cancel for an origin just
///         above a large triangle, and its last bit would decide at random which id wins at a shared edge.
/// Source: the volumes are those of S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1),
///        2013, before their shear; W. Kahan for the differences of products; J. R. Shewchuk, "Adaptive Precision
///        Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997, for exactness on demand. Tested by
///        tests/kernel/shapes/triangle_test.cpp and mesh_test.cpp.
template <class Real, class Number>
TANDEM_HD_INLINE Mask<Real> first_hit(const Vec3<Number>& v0, const Vec3<Number>& v1, const Vec3<Number>& v2,
                                      const Ray<Real>& ray, Double<Real>& t,
                                      const Mask<Real>& active = Mask<Real>(true),
                                      const Double<Real>& farthest = Double<Real>(__builtin_huge_val())) {
    if (!any(active)) return active;
    t = triangle_detail::parameter<Real>(v0, v1, v2, ray, active, farthest);
    return active && t > Double<Real>(0.0) && t < Double<Real>(__builtin_huge_val());
}

template <class Real>
TANDEM_HD_INLINE Mask<Real> first_hit(const Triangle& triangle, const Ray<Real>& ray, Double<Real>& t,
                                      const Mask<Real>& active = Mask<Real>(true),
                                      const Double<Real>& farthest = Double<Real>(__builtin_huge_val())) {
    return first_hit(triangle.v0, triangle.v1, triangle.v2, ray, t, active, farthest);
}

/// The barycentric coordinates of a hit, in the lanes of `active`, whose rays hit the triangle. Within 2^-22 of the
/// exact ones, except in the tier fast.
template <class Real, class Number>
TANDEM_HD_INLINE Barycentrics<Double<Real>> barycentrics(const Vec3<Number>& v0, const Vec3<Number>& v1,
                                                         const Vec3<Number>& v2, const Ray<Real>& ray,
                                                         const Mask<Real>& active) {
    using D = Double<Real>;
    Barycentrics<D> at;
    if constexpr (is_fast<Real>) {
        at = triangle_detail::RoughCrossing<Real>(v0, v1, v2, ray).at;
    } else {
        at = triangle_detail::fine_barycentrics(v0, v1, v2, ray, active);
    }
    const auto clamp = [](const D& x, const D& most) { return lesser(greater(x, D(0.0)), most); };
    at.u = clamp(at.u, D(1.0));
    at.v = clamp(at.v, D(1.0) - at.u);
    return at;
}

namespace triangle_detail {

/// One component of (v1 - v0) x (v2 - v0), along a coordinate axis, without rounding.
TANDEM_HD_INLINE ExactSum<float> shadow(const Vec3f& v0, const Vec3f& v1, const Vec3f& v2, const Vec3f& axis) {
    ExactSum<float> sum;
    add_determinant(sum, v0, v1, axis);
    add_determinant(sum, v1, v2, axis);
    add_determinant(sum, v2, v0, axis);
    return sum;
}

/// The direction of (v1 - v0) x (v2 - v0), from exact components; below 2^33 in size. Zero for a degenerate triangle.
TANDEM_HD_CALL Vec3d exact_normal_direction(Vec3f v0, Vec3f v1, Vec3f v2) {
    ScaledPair parts[3];
    TANDEM_KEEP_LOOP
    for (int i = 0; i < 3; ++i) {
        const Vec3f axis = {i == 0 ? 1.0F : 0.0F, i == 1 ? 1.0F : 0.0F, i == 2 ? 1.0F : 0.0F};
        parts[i] = shadow(v0, v1, v2, axis).leading();
    }
    const auto& [x, y, z] = parts;
    const auto larger = [](const ScaledPair& a, const ScaledPair& b) {
        if (b.mantissa.high == 0.0) return a;
        return a.mantissa.high == 0.0 || a.exponent < b.exponent ? b : a;
    };
    const ScaledPair unit = {{1.0, 0.0}, larger(larger(x, y), z).exponent};
    return {quotient(x, unit), quotient(y, unit), quotient(z, unit)};
}

}  // namespace triangle_detail

namespace triangle_detail {

/// Unit geometric normal in double, by corners in double. `exact_direction(i)`: exact_normal_direction() in lane i.
template <class D, class ExactDirection>
TANDEM_HD_INLINE Vec3<D> unit_normal(const Vec3<D>& v0, const Vec3<D>& v1, const Vec3<D>& v2,
                                     const ExactDirection& exact_direction) {
    const Vec3<D> e1 = v1 - v0;
    const Vec3<D> e2 = v2 - v0;
    Vec3<D> direction = accurate_cross(e1, e2);
    // unless the edges are nearly parallel, the rounding of the edges, 2^-53 of each, is the whole error
    const auto accurate = norm1(direction) > D(0x1p-20) * (norm1(e1) * norm1(e2));
    if (!all(accurate)) [[unlikely]] {
        for (int i = 0; i < RealTraits<D>::lanes; ++i) {
            if (lane(accurate, i)) continue;
            const Vec3d exact = exact_direction(i);
            set_lane(direction.x, i, exact.x);
            set_lane(direction.y, i, exact.y);
            set_lane(direction.z, i, exact.z);
        }
    }
    return normalize(direction);
}

}  // namespace triangle_detail

/// Unit geometric normal, on the front. Within 2^-28. Needs a triangle that is not degenerate.
TANDEM_HD_INLINE Vec3d triangle_normal(const Vec3f& v0, const Vec3f& v1, const Vec3f& v2) {
    return triangle_detail::unit_normal(widen(v0), widen(v1), widen(v2),
                                        [&](int) { return triangle_detail::exact_normal_direction(v0, v1, v2); });
}

/// The same for all lanes; in float in the tier fast.
template <class Real, class Number>
TANDEM_HD_INLINE Vec3<Double<Real>> geometric_normal(const Vec3<Number>& v0, const Vec3<Number>& v1,
                                                     const Vec3<Number>& v2) {
    using D = Double<Real>;
    if constexpr (is_fast<Real>) {
        return normalize(cross(broadcast<D>(v1 - v0), broadcast<D>(v2 - v0)));
    } else if constexpr (std::is_same_v<Number, float>) {
        return broadcast<D>(triangle_normal(v0, v1, v2));
    } else {
        using triangle_detail::one_corner;
        const auto exact_direction = [&](int i) {
            return triangle_detail::exact_normal_direction(one_corner(v0, i), one_corner(v1, i), one_corner(v2, i));
        };
        return triangle_detail::unit_normal(widen(v0), widen(v1), widen(v2), exact_direction);
    }
}

/// Whether a ray comes from behind a face. `normal`: its geometric_normal().
template <class Real>
TANDEM_HD_INLINE Mask<Real> comes_from_behind(const Ray<Real>& ray, const Vec3<Double<Real>>& normal) {
    return dot(widen(ray.direction), normal) > Double<Real>(0.0);
}

/// Whether the area is exactly zero. No ray hits such a triangle.
[[nodiscard]] TANDEM_HD_INLINE bool is_degenerate(const Vec3f& v0, const Vec3f& v1, const Vec3f& v2) {
    const Vec3d e1 = widen(v1) - widen(v0);
    const Vec3d e2 = widen(v2) - widen(v0);
    if (norm1(cross(e1, e2)) > triangle_detail::volume_error * (norm1(e1) * norm1(e2))) return false;
    const Vec3f axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const Vec3f& axis : axes) {
        if (triangle_detail::shadow(v0, v1, v2, axis).sign() != 0) return false;
    }
    return true;
}

/// A triangle has one part.
template <class Real>
TANDEM_HD_INLINE HitRecord<Real> record_hit(const Triangle&, const Ray<Real>&, const Double<Real>&, const Mask<Real>&,
                                            const Mask<Real>&) {
    return {};
}

}  // namespace tandem
