/// Texture coordinates on solids and faces, at a ray's hit. (0, 0) is the upper left corner of an image and v points
/// down, as in glTF 2.0.
///
///   sphere, ellipsoid     the globe: u = 1/2 + longitude / 2 pi grows to the east, seen from outside, from +z (1/2)
///                         towards +x (3/4); v = 0 at the pole +y, 1 at -y. At the poles u is 1/2
///   box, parallelepiped   the whole square on each face, not mirrored, seen from outside. +x, -x, +z, -z: upright, the
///                         top at +y. +y: its top at -z, and -y: its top at +z
///   triangle, quad        the coordinates of their corners, linear in each triangle; without these, a quad has the
///                         whole square, v0 (0, 0), v1 (1, 0), v2 (1, 1), v3 (0, 1), and a triangle the half with
///                         v0 (0, 0), v1 (1, 0), v2 (0, 1)
///
/// Spheres and boxes have the axes of the world, ellipsoids and parallelepipeds those of their object space. So
/// prepare() converts textured primitives that are rotated or mirrored to the latter.
#pragma once

#include <type_traits>

#include "tandem/kernel/shapes/affine.h"
#include "tandem/kernel/shapes/quad.h"
#include "tandem/math/turns.h"

namespace tandem {

/// The number of corners of a face; 0 for solids.
template <class Primitive>
inline constexpr std::uint32_t corner_count = std::is_same_v<Primitive, Triangle> ? 3
                                              : std::is_same_v<Primitive, Quad>   ? 4
                                                                                  : 0;

/// u and v of a point, and the directions of their growth: world space, of any length. Zero or parallel where the
/// texture coordinates of a face span no area.
template <class Real>
struct Parametrisation {
    Double<Real> u, v;
    Vec3<Double<Real>> dp_du, dp_dv;
};

namespace parametrisation_detail {

/// `p`: from the centre to the point, of any length. The directions are in the space of p; at the poles those of
/// longitude 0.
template <class Real>
TANDEM_HD_INLINE Parametrisation<Real> on_globe(const Vec3<Double<Real>>& p) {
    using D = Double<Real>;
    const D zero(0.0);
    const D half(0.5);
    const D radius2 = p.x * p.x + p.z * p.z;
    const Mask<Real> off_pole = radius2 > zero;
    Parametrisation<Real> result;
    result.u = half + atan2_turns<Real>(p.x, p.z);
    result.v = D(2.0) * atan2_turns<Real>(square_root(radius2), p.y);
    result.dp_du = {select(off_pole, p.z, D(1.0)), zero, -p.x};
    result.dp_dv = {p.x * p.y, -radius2, select(off_pole, p.y * p.z, p.y)};
    return result;
}

/// `at`: the point along each axis, 0 to 1. `face`: the outward normal, along an axis. The directions are in the space
/// of both.
template <class Real>
TANDEM_HD_INLINE Parametrisation<Real> on_box(const Vec3<Double<Real>>& at, const Vec3<Double<Real>>& face) {
    using D = Double<Real>;
    const D zero(0.0);
    const D one(1.0);
    const Mask<Real> on_x = face.x != zero;
    const Mask<Real> on_y = face.y != zero;
    const D right_of_x = select(face.x > zero, one - at.z, at.z);
    const D right_of_z = select(face.z < zero, one - at.x, at.x);
    Parametrisation<Real> result;
    result.u = select(on_x, right_of_x, select(on_y, at.x, right_of_z));
    result.v = select(on_y, select(face.y > zero, at.z, one - at.z), one - at.y);
    result.dp_du = {select(on_y, one, face.z), zero, -face.x};
    result.dp_dv = {zero, select(on_y, zero, -one), face.y};
    return result;
}

template <class Real>
TANDEM_HD_INLINE Double<Real> clamp_to_one(const Double<Real>& a) {
    return lesser(greater(a, Double<Real>(0.0)), Double<Real>(1.0));
}

template <class Real>
TANDEM_HD_INLINE Vec3<Double<Real>> point_at(const ObjectRay<Real>& ray, const Double<Real>& t) {
    return {ray.origin.x + t * ray.direction.x, ray.origin.y + t * ray.direction.y, ray.origin.z + t * ray.direction.z};
}

/// Transforms the directions from object space.
template <class Real>
TANDEM_HD_INLINE Parametrisation<Real> to_world(const Placement& placement, const Parametrisation<Real>& own) {
    const Matrix3 world_from_object = inverse(placement.object_from_world);
    return {own.u, own.v, multiply(world_from_object, own.dp_du), multiply(world_from_object, own.dp_dv)};
}

/// On the triangle (v0, v1, v2), whose corners have the texture coordinates a, b, c.
template <class Real, class Number>
TANDEM_HD_CALL Parametrisation<Real> on_triangle(Vec3<Number> v0, Vec3<Number> v1, Vec3<Number> v2, Vec2<Number> a,
                                                 Vec2<Number> b, Vec2<Number> c, Ray<Real> ray, Mask<Real> here) {
    using D = Double<Real>;
    const Barycentrics<D> at = barycentrics(v0, v1, v2, ray, here);
    const D rest = (D(1.0) - at.u) - at.v;
    const auto number = [](const Number& x) { return corner_number<Real>(x); };
    using S = decltype(number(a.x));
    Parametrisation<Real> result;
    result.u = (D(number(a.x)) * rest + D(number(b.x)) * at.u) + D(number(c.x)) * at.v;
    result.v = (D(number(a.y)) * rest + D(number(b.y)) * at.u) + D(number(c.y)) * at.v;
    // The edges are e = dp_du * du + dp_dv * dv, solved up to the magnitude of the determinant.
    const Vec3<S> p0 = corner_point<Real>(v0);
    const Vec3<S> e1 = corner_point<Real>(v1) - p0;
    const Vec3<S> e2 = corner_point<Real>(v2) - p0;
    const S du1 = number(b.x) - number(a.x);
    const S dv1 = number(b.y) - number(a.y);
    const S du2 = number(c.x) - number(a.x);
    const S dv2 = number(c.y) - number(a.y);
    const S sign = select(du1 * dv2 < du2 * dv1, S(-1.0), S(1.0));
    result.dp_du = broadcast<D>((e1 * dv2 - e2 * dv1) * sign);
    result.dp_dv = broadcast<D>((e2 * du1 - e1 * du2) * sign);
    return result;
}

/// The texture coordinates at the corners of a face; by default those of the whole square, or half of it for a
/// triangle.
template <int count>
struct Corners {
    Vec2f uv[count];
};
template <int count>
TANDEM_HD_INLINE Corners<count> default_corners() {
    if constexpr (count == 3) {
        return {{{0, 0}, {1, 0}, {0, 1}}};
    } else {
        return {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    }
}
TANDEM_HD_INLINE Corners<3> corners_of(const Triangle& face, const Vec2f* texcoords) {
    const std::uint32_t first = face.attributes.texcoords;
    if (first == no_attributes) return default_corners<3>();
    return {{texcoords[first], texcoords[first + 1], texcoords[first + 2]}};
}
TANDEM_HD_INLINE Corners<4> corners_of(const Quad& face, const Vec2f* texcoords) {
    const std::uint32_t first = face.attributes.texcoords;
    if (first == no_attributes) return default_corners<4>();
    return {{texcoords[first], texcoords[first + 1], texcoords[first + 2], texcoords[first + 3]}};
}

}  // namespace parametrisation_detail

// The parametrisation of each kind of primitive where `ray` hits it at `t`, in the lanes of `here`. `record`:
// record_hit() of this hit. `texcoords`: one slot of PreparedScene::texcoords.
//
// Gives: u and v within 2^-21 on faces and 1e-12 on solids, but less accurately where one ulp of the ray moves the hit
//        far along the surface. In the tier fast as accurate as float. Tested by
//        tests/kernel/shapes/parametrisation_test.cpp.

template <class Real>
TANDEM_HD_INLINE Parametrisation<Real> parametrisation(const Sphere& sphere, const HitRecord<Real>&, const Vec2f*,
                                                       const Ray<Real>& ray, const Double<Real>& t, const Mask<Real>&) {
    return parametrisation_detail::on_globe<Real>(sphere_offset(sphere, ray, t));
}

template <class Real>
TANDEM_HD_INLINE Parametrisation<Real> parametrisation(const Ellipsoid& body, const HitRecord<Real>&, const Vec2f*,
                                                       const Ray<Real>& ray, const Double<Real>& t, const Mask<Real>&) {
    const auto own = parametrisation_detail::on_globe<Real>(parametrisation_detail::point_at(to_object(body, ray), t));
    return parametrisation_detail::to_world(body, own);
}

template <class Real>
TANDEM_HD_INLINE Parametrisation<Real> parametrisation(const Box& box, const HitRecord<Real>& record, const Vec2f*,
                                                       const Ray<Real>& ray, const Double<Real>& t, const Mask<Real>&) {
    using D = Double<Real>;
    const Vec3<D> direction = widen(ray.direction);
    const auto along = [&](const D& o, const D& d, float lower, float upper) {
        // across a flat box the size is 0 and the value does not matter
        const D size = D(upper) - D(lower);
        const D from_lower = (o - D(lower)) + t * d;
        return parametrisation_detail::clamp_to_one<Real>(from_lower / select(size > D(0.0), size, D(1.0)));
    };
    const Vec3<D> origin = widen(ray.origin);
    const Vec3<D> at = {along(origin.x, direction.x, box.lower.x, box.upper.x),
                        along(origin.y, direction.y, box.lower.y, box.upper.y),
                        along(origin.z, direction.z, box.lower.z, box.upper.z)};
    return parametrisation_detail::on_box<Real>(at, face_normal(record));
}

template <class Real>
TANDEM_HD_INLINE Parametrisation<Real> parametrisation(const Parallelepiped& body, const HitRecord<Real>& record,
                                                       const Vec2f*, const Ray<Real>& ray, const Double<Real>& t,
                                                       const Mask<Real>&) {
    using D = Double<Real>;
    const ObjectRay<Real> local = to_object(body, ray);
    const Vec3<D> p = parametrisation_detail::point_at(local, t);
    const auto along = [](const D& x) { return parametrisation_detail::clamp_to_one<Real>(D(0.5) * x + D(0.5)); };
    const auto own =
        parametrisation_detail::on_box<Real>(Vec3<D>{along(p.x), along(p.y), along(p.z)}, face_normal(record));
    return parametrisation_detail::to_world(body, own);
}

template <class Real>
TANDEM_HD_INLINE Parametrisation<Real> parametrisation(const Triangle& triangle, const HitRecord<Real>&,
                                                       const Vec2f* texcoords, const Ray<Real>& ray,
                                                       const Double<Real>&, const Mask<Real>& here) {
    const auto corner = parametrisation_detail::corners_of(triangle, texcoords);
    return parametrisation_detail::on_triangle<Real>(triangle.v0, triangle.v1, triangle.v2, corner.uv[0], corner.uv[1],
                                                     corner.uv[2], ray, here);
}

template <class Real>
TANDEM_HD_INLINE Parametrisation<Real> parametrisation(const Quad& quad, const HitRecord<Real>& record,
                                                       const Vec2f* texcoords, const Ray<Real>& ray,
                                                       const Double<Real>&, const Mask<Real>& here) {
    using D = Double<Real>;
    const auto corner = parametrisation_detail::corners_of(quad, texcoords);
    const auto& [a, b, c, d] = corner.uv;
    const Mask<Real> first = is_in_first_half(record);
    Parametrisation<Real> result{};
    if (any(here && first)) {
        result = parametrisation_detail::on_triangle<Real>(quad.v0, quad.v1, quad.v2, a, b, c, ray, here && first);
    }
    if (any(here && !first)) {
        const auto second =
            parametrisation_detail::on_triangle<Real>(quad.v0, quad.v2, quad.v3, a, c, d, ray, here && !first);
        const auto choose = [&](const D& x, const D& y) { return select(first, x, y); };
        result = {choose(result.u, second.u),
                  choose(result.v, second.v),
                  {choose(result.dp_du.x, second.dp_du.x), choose(result.dp_du.y, second.dp_du.y),
                   choose(result.dp_du.z, second.dp_du.z)},
                  {choose(result.dp_dv.x, second.dp_dv.x), choose(result.dp_dv.y, second.dp_dv.y),
                   choose(result.dp_dv.z, second.dp_dv.z)}};
    }
    return result;
}

}  // namespace tandem
