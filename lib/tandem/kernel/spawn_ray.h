/// Points on surfaces, and the rays that leave from them.
///
/// A hit point is projected onto its surface in double and then rounded to Real once: for spheres and ellipsoids along
/// the line from the centre, for boxes by copying the coordinate of the face, for triangles along the normal. The
/// rounded point is still off the surface by up to half an ulp. This is harmless for the primitive itself, because the
/// ray carries its source (ray_source.h). But the neighbours of a face in a mesh are separate primitives. So a ray that
/// leaves a face starts at an offset from its plane, on the ray's side, that rounding cannot undo. Then it cannot hit
/// anything behind the plane, such as the rest of a flat or convex mesh.
#pragma once

#include <type_traits>

#include "tandem/kernel/shapes/ray_source.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem {

/// A point of a primitive's surface, world space.
template <class Real>
struct SurfacePoint {
    Vec3<Real> position;
    /// The geometric normal: unit, outward, at the point before rounding.
    Vec3<Double<Real>> normal;
    UInt<Real> primitive = UInt<Real>(no_primitive);
    Double<Real> clearance = Double<Real>(0.0);  ///< for a face: distance from its plane at which rays start
    Mask<Real> from_inside = Mask<Real>(false);  ///< the ray hit the inner side of the surface
};

namespace spawn_detail {

/// Point of a ray in double.
template <class Real>
TANDEM_HD Vec3<Double<Real>> along(const Vec3<Double<Real>>& origin, const Vec3<Double<Real>>& direction,
                                   const Double<Real>& t) {
    return {origin.x + t * direction.x, origin.y + t * direction.y, origin.z + t * direction.z};
}

/// A point given as an offset from the centre of a transformed solid.
template <class Real>
TANDEM_HD Vec3<Real> at_offset(const Placement& placement, const Ray<Real>& ray, const Double<Real>& t,
                               const Double<Real>& scale) {
    using D = Double<Real>;
    const Vec3<D> centre = constant<D>(placement.centre);
    const Vec3<D> offset = along<Real>(widen(ray.origin) - centre, widen(ray.direction), t);
    return to_real<Real>(
        Vec3<D>{centre.x + offset.x * scale, centre.y + offset.y * scale, centre.z + offset.z * scale});
}

}  // namespace spawn_detail

// The surface point at a hit. `t`: the tracer's. `record`: record_hit() of this hit.

template <class Real>
TANDEM_HD SurfacePoint<Real> surface_point(const Sphere& sphere, const HitRecord<Real>& record, const Ray<Real>& ray,
                                           const Double<Real>& t) {
    using D = Double<Real>;
    SurfacePoint<Real> point;
    point.normal = sphere_normal(sphere, ray, t);
    const Vec3<D> centre = broadcast<D>(sphere.centre);
    point.from_inside = record.from_inside;
    point.position = to_real<Real>(spawn_detail::along<Real>(centre, point.normal, D(sphere.radius)));
    return point;
}

template <class Real>
TANDEM_HD SurfacePoint<Real> surface_point(const Box& box, const HitRecord<Real>& record, const Ray<Real>& ray,
                                           const Double<Real>& t) {
    using D = Double<Real>;
    SurfacePoint<Real> point;
    point.normal = face_normal(record);
    point.from_inside = record.from_inside;
    const auto near = to_real<Real>(spawn_detail::along<Real>(widen(ray.origin), widen(ray.direction), t));
    const auto coordinate = [](const Real& x, float lower, float upper, const D& normal) {
        const Real lo(lower);
        const Real hi(upper);
        const Real within = select(x < lo, lo, select(x > hi, hi, x));
        const D zero(0.0);
        return select(normal < zero, lo, select(normal > zero, hi, within));
    };
    point.position = {coordinate(near.x, box.lower.x, box.upper.x, point.normal.x),
                      coordinate(near.y, box.lower.y, box.upper.y, point.normal.y),
                      coordinate(near.z, box.lower.z, box.upper.z, point.normal.z)};
    return point;
}

template <class Real>
TANDEM_HD SurfacePoint<Real> surface_point(const Ellipsoid& body, const HitRecord<Real>& record, const Ray<Real>& ray,
                                           const Double<Real>& t) {
    using D = Double<Real>;
    SurfacePoint<Real> point;
    point.normal = ellipsoid_normal(body, ray, t);
    const ObjectRay<Real> local = to_object(body, ray);
    point.from_inside = record.from_inside;
    const Vec3<D> unit_point = spawn_detail::along<Real>(local.origin, local.direction, t);
    // a scale of the offset from the centre is the same scale in object space
    point.position = spawn_detail::at_offset(body, ray, t, inverse_square_root(dot(unit_point, unit_point)));
    return point;
}

template <class Real>
TANDEM_HD SurfacePoint<Real> surface_point(const Parallelepiped& body, const HitRecord<Real>& record,
                                           const Ray<Real>& ray, const Double<Real>& t) {
    using D = Double<Real>;
    SurfacePoint<Real> point;
    point.normal = parallelepiped_normal(body, record);
    point.from_inside = record.from_inside;
    const ObjectRay<Real> local = to_object(body, ray);
    const Vec3<D> face = face_normal(record);
    const Vec3<D> cube_point = spawn_detail::along<Real>(local.origin, local.direction, t);
    point.position = spawn_detail::at_offset(body, ray, t, D(1.0) / absolute(dot(cube_point, face)));
    return point;
}

namespace spawn_detail {

/// A point of the plane through v0 with the given normal, and a bound on its distance from that plane by rounding.
template <class Real, class Number>
TANDEM_HD SurfacePoint<Real> plane_point(const Vec3<Number>& v0, const Vec3<Double<Real>>& normal, const Ray<Real>& ray,
                                         const Double<Real>& t) {
    using D = Double<Real>;
    const Vec3<D> origin = broadcast<D>(corner_point<Real>(v0));
    SurfacePoint<Real> point;
    point.normal = normal;
    point.from_inside = comes_from_behind(ray, normal);
    const Vec3<D> hit = along<Real>(widen(ray.origin), widen(ray.direction), t);
    const D above = dot(hit - origin, normal);
    point.position = to_real<Real>(along<Real>(hit, normal, -above));
    // Two roundings to Real, of the point and of the offset point, by at most half an ulp of each coordinate. In the
    // tiers whose Double<Real> is Real, the errors of the lines above come on top.
    using Scalar = typename RealTraits<Real>::Scalar;
    const double unit = sizeof(Scalar) == sizeof(float) ? 0x1p-24 : 0x1p-53;
    const double units = std::is_same_v<Real, D> ? 16 : 3;
    const Vec3<D> reach = {absolute(hit.x) + absolute(origin.x), absolute(hit.y) + absolute(origin.y),
                           absolute(hit.z) + absolute(origin.z)};
    const Vec3<D> weight = {absolute(normal.x), absolute(normal.y), absolute(normal.z)};
    point.clearance = constant<D>(units * unit) * dot(reach, weight);
    return point;
}

}  // namespace spawn_detail

template <class Real>
TANDEM_HD SurfacePoint<Real> surface_point(const Triangle& triangle, const HitRecord<Real>&, const Ray<Real>& ray,
                                           const Double<Real>& t) {
    const auto normal = geometric_normal<Real>(triangle.v0, triangle.v1, triangle.v2);
    return spawn_detail::plane_point(triangle.v0, normal, ray, t);
}

template <class Real>
TANDEM_HD SurfacePoint<Real> surface_point(const Quad& quad, const HitRecord<Real>& record, const Ray<Real>& ray,
                                           const Double<Real>& t) {
    const Mask<Real> first = is_in_first_half(record);
    const auto a = geometric_normal<Real>(quad.v0, quad.v1, quad.v2);
    const auto b = geometric_normal<Real>(quad.v0, quad.v2, quad.v3);
    // both halves have the corner v0
    return spawn_detail::plane_point(quad.v0, select(first, a, b), ray, t);
}

/// is_far_side() of primitive `id`, of any type.
template <std::uint32_t kinds = PrimitiveKinds::all, class Real, class From>
TANDEM_HD Mask<Real> hits_far_side(const SceneView& scene, std::uint32_t id, const Ray<Real>& ray, const From& source,
                                   const Double<Real>& t, const Mask<Real>& here) {
    Mask<Real> far = leaves_inward<Real>(source, id);
    if constexpr (std::is_same_v<From, PathSource<Real>>) {
        if (has_no_masks(scene) || !any(source.last_masked.t > Double<Real>(0.0))) return far;
        visit_primitive<kinds>(scene, id, [&](const auto& primitive) {
            // rays pass the near side only of solids with an alpha mask
            if (!may_be_cut_out(kind_of<std::decay_t<decltype(primitive)>>)) return;
            far = is_far_side<Real>(source, primitive, id, ray, t, here);
        });
    }
    return far;
}

/// The surface point of primitive `id` at t of a ray from `source` (NoSource, Source<Real> or PathSource<Real>).
/// `kinds`: the possible kinds of the primitive.
template <std::uint32_t kinds = PrimitiveKinds::all, class Real, class From>
TANDEM_HD SurfacePoint<Real> surface_point_of(const SceneView& scene, std::uint32_t id, const Ray<Real>& ray,
                                              const From& source, const Double<Real>& t,
                                              const Mask<Real>& here = Mask<Real>(true)) {
    const Mask<Real> exits = hits_far_side<kinds>(scene, id, ray, source, t, here);
    SurfacePoint<Real> point;
    visit_primitive<kinds>(scene, id, [&](const auto& primitive) {
        point = surface_point(primitive, record_hit(primitive, ray, t, exits, here), ray, t);
    });
    point.primitive = UInt<Real>(id);
    return point;
}

/// Copies `own` to `point` in the lanes of `here`.
template <class Real>
TANDEM_HD void keep(const Mask<Real>& here, const SurfacePoint<Real>& own, SurfacePoint<Real>& point) {
    point.position = select(here, own.position, point.position);
    point.normal = select(here, own.normal, point.normal);
    point.clearance = select(here, own.clearance, point.clearance);
    point.from_inside = select(here, own.from_inside, point.from_inside);
    point.primitive = select(here, own.primitive, point.primitive);
}

/// The surface point at `hit` of `ray` from `source`, in the lanes of `found`.
template <std::uint32_t kinds = PrimitiveKinds::all, class Real, class From>
TANDEM_HD_CALL_ON(host)
SurfacePoint<Real> surface_point(const SceneView& scene, const Ray<Real>& ray, const From& source,
                                 const Closest<Real>& hit, const Mask<Real>& found) {
    SurfacePoint<Real> result = {ray.origin, widen(ray.direction)};
    for_each_unique_lane(hit.primitive, found, [&](std::uint32_t id, const Mask<Real>& here) {
        keep(here, surface_point_of<kinds>(scene, id, ray, source, hit.t, here), result);
    });
    return result;
}

/// A ray and its source.
template <class Real>
struct SpawnedRay {
    Ray<Real> ray;
    Source<Real> source;
};

/// The origin of rays that leave a point, inward in the lanes of `inside`.
template <class Real>
TANDEM_HD Vec3<Real> departure(const SurfacePoint<Real>& from, const Mask<Real>& inside) {
    using D = Double<Real>;
    if (!any(from.clearance > D(0.0))) return from.position;
    const D height = select(inside, -from.clearance, from.clearance);
    return to_real<Real>(spawn_detail::along<Real>(widen(from.position), from.normal, height));
}

/// A ray from a surface point. Its side is the sign of direction . normal, in double; a direction in the tangent plane
/// leaves outward.
template <class Real>
TANDEM_HD SpawnedRay<Real> spawn_ray(const SurfacePoint<Real>& from, const Vec3<Real>& direction) {
    const Mask<Real> inside = dot(widen(direction), from.normal) < Double<Real>(0.0);
    return {{departure(from, inside), direction}, {from.primitive, inside}};
}

/// The end of a shadow ray that does not count, relative to its length. Without it, the rounding of the direction would
/// decide whether the ray hits a surface on which the light lies. With it, the ray does not hit such a surface if the
/// cosine to its normal is above 1 / 16.
template <class Real>
inline constexpr double shadow_gap = std::is_same_v<Scalar<Real>, double> ? 0x1p-49
                                     : is_fast<Real>                      ? 0x1p-18
                                                                          : 0x1p-20;

/// A shadow ray, for Tracer::occluded(). Its light is at t = 1, or infinitely far.
template <class Real>
struct ShadowRay {
    Ray<Real> ray;
    ShadowSource<Real> source;
    Double<Real> t_max = constant<Double<Real>>(1.0 - shadow_gap<Real>);
    /// False where the light is at the point itself, so that the ray has no direction, and where the ray overflows in
    /// the tier fast. In both cases the light contributes nothing.
    Mask<Real> active;
};

/// The shadow ray to a light at the point `to` or, where it `is_far`, in the direction `to`. `light`: the light's own
/// primitive, or no_primitive.
template <class Real>
TANDEM_HD ShadowRay<Real> spawn_shadow_ray(const SurfacePoint<Real>& from, const Vec3<Real>& to,
                                           const UInt<Real>& light, const Mask<Real>& is_far = Mask<Real>(false)) {
    using D = Double<Real>;
    ShadowRay<Real> shadow;
    shadow.source.primitive = from.primitive;
    const Vec3<D> to_light = select(is_far, widen(to), widen(to) - widen(from.position));
    shadow.source.inside = dot(to_light, from.normal) < D(0.0);
    shadow.source.light = light;
    shadow.ray.origin = departure(from, shadow.source.inside);
    shadow.ray.direction = select(is_far, to, to_real<Real>(widen(to) - widen(shadow.ray.origin)));
    shadow.t_max = select(is_far, D(__builtin_huge_val()), shadow.t_max);
    shadow.active = is_traceable(shadow.ray) && (is_far || norm1(to_light) > D(0.0));
    return shadow;
}

}  // namespace tandem
