/// Points of surfaces, and the rays that leave from them.
///
/// A point is brought back onto its surface in double and then rounded to Real once: a sphere's and an ellipsoid's along
/// the line from the centre, a face of a box by copying its coordinate. Rounding still leaves it beside the surface, by up
/// to half the distance of numbers there; that is harmless, because the ray carries what it leaves (ray_source.h).
#pragma once

#include "tandem/geometry/ray_source.h"
#include "tandem/scene/scene_view.h"

namespace tandem {

/// A point of a primitive's surface, world space.
template <class Real>
struct SurfacePoint {
    Vec3<Real> position;
    Vec3<Double<Real>> normal;  ///< unit, outward, of the point before rounding
    UInt<Real> primitive = UInt<Real>(no_primitive);
};

namespace spawn_detail {

/// Point of a ray in double.
template <class Real>
TANDEM_HD Vec3<Double<Real>> along(const Vec3<Double<Real>>& origin, const Vec3<Double<Real>>& direction,
                                   const Double<Real>& t) {
    return {origin.x + t * direction.x, origin.y + t * direction.y, origin.z + t * direction.z};
}

/// A point that is given as an offset from the centre of a placed body.
template <class Real>
TANDEM_HD Vec3<Real> at_offset(const Placement& placement, const Ray<Real>& ray, const Double<Real>& t,
                               const Double<Real>& scale) {
    using D = Double<Real>;
    const Vec3<D> centre = constant<D>(placement.centre);
    const Vec3<D> offset = along<Real>(widen(ray.origin) - centre, widen(ray.direction), t);
    return to_real<Real>(Vec3<D>{centre.x + offset.x * scale, centre.y + offset.y * scale, centre.z + offset.z * scale});
}

}  // namespace spawn_detail

// The point of a primitive at a hit. `t` is the one that the tracer found; `exits`: it is the far side of the primitive
// that the ray left inward, so the ray comes from within, whatever rounding has done to its origin.

template <class Real>
TANDEM_HD SurfacePoint<Real> surface_point(const Sphere& sphere, const Ray<Real>& ray, const Double<Real>& t,
                                           const Mask<Real>&) {
    using D = Double<Real>;
    SurfacePoint<Real> point;
    point.normal = sphere_normal(sphere, ray, t);
    const Vec3<D> centre = broadcast<D>(sphere.centre);
    point.position = to_real<Real>(spawn_detail::along<Real>(centre, point.normal, D(sphere.radius)));
    return point;
}

template <class Real>
TANDEM_HD SurfacePoint<Real> surface_point(const Box& box, const Ray<Real>& ray, const Double<Real>& t,
                                           const Mask<Real>& exits) {
    using D = Double<Real>;
    SurfacePoint<Real> point;
    const Vec3<D> direction = widen(ray.direction);
    point.normal = face_normal<Real>(cross_box(box, ray), direction, exits);
    const auto near = to_real<Real>(spawn_detail::along<Real>(widen(ray.origin), direction, t));
    const auto coordinate = [](const Real& x, float lower, float upper, const D& normal) TANDEM_INLINE_LAMBDA {
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
TANDEM_HD SurfacePoint<Real> surface_point(const Ellipsoid& body, const Ray<Real>& ray, const Double<Real>& t,
                                           const Mask<Real>&) {
    using D = Double<Real>;
    SurfacePoint<Real> point;
    point.normal = ellipsoid_normal(body.placement, ray, t);
    const ObjectRay<Real> local = to_object(body.placement, ray);
    const Vec3<D> unit_point = spawn_detail::along<Real>(local.origin, local.direction, t);
    // scaling the offset from the centre scales its image in object space alike
    point.position = spawn_detail::at_offset(body.placement, ray, t, inverse_square_root(dot(unit_point, unit_point)));
    return point;
}

template <class Real>
TANDEM_HD SurfacePoint<Real> surface_point(const Parallelepiped& body, const Ray<Real>& ray, const Double<Real>& t,
                                           const Mask<Real>& exits) {
    using D = Double<Real>;
    SurfacePoint<Real> point;
    point.normal = parallelepiped_normal(body.placement, ray, exits);
    const ObjectRay<Real> local = to_object(body.placement, ray);
    const Vec3<D> face = face_normal<Real>(cross_parallelepiped(local), local.direction, exits);
    const Vec3<D> cube_point = spawn_detail::along<Real>(local.origin, local.direction, t);
    point.position = spawn_detail::at_offset(body.placement, ray, t, D(1.0) / absolute(dot(cube_point, face)));
    return point;
}

/// The point of primitive `id` at t of a ray that comes from `source` (NoSource or Source<Real>).
template <class Real, class From>
TANDEM_HD SurfacePoint<Real> surface_point_of(const SceneView& scene, std::uint32_t id, const Ray<Real>& ray,
                                              const From& source, const Double<Real>& t) {
    const Mask<Real> exits = leaves_inward<Real>(source, id);
    SurfacePoint<Real> point;
    const auto take = [&](const auto& primitive)
                          TANDEM_INLINE_LAMBDA { point = surface_point(primitive, ray, t, exits); };
    visit_primitive(
        scene, id, take, take, [&](const Placement& p) TANDEM_INLINE_LAMBDA { take(Ellipsoid{p}); },
        [&](const Placement& p) TANDEM_INLINE_LAMBDA { take(Parallelepiped{p}); });
    point.primitive = UInt<Real>(id);
    return point;
}

/// The point of a scene at `hit`, which `ray` from `source` found, in the lanes of `found`.
template <class Real, class From>
TANDEM_HD SurfacePoint<Real> surface_point(const SceneView& scene, const Ray<Real>& ray, const From& source,
                                           const Closest<Real>& hit, const Mask<Real>& found) {
    SurfacePoint<Real> result = {ray.origin, widen(ray.direction)};
    for_each_value(hit.primitive, found, [&](std::uint32_t id, const Mask<Real>& here) TANDEM_INLINE_LAMBDA {
        const SurfacePoint<Real> point = surface_point_of(scene, id, ray, source, hit.t);
        result.position = select(here, point.position, result.position);
        result.normal = select(here, point.normal, result.normal);
        result.primitive = select(here, UInt<Real>(id), result.primitive);
    });
    return result;
}

/// A ray and what it leaves.
template <class Real>
struct SpawnedRay {
    Ray<Real> ray;
    Source<Real> source;
};

/// A ray from a point of a surface. The side follows from the sign of direction . normal, in double; a direction in the
/// tangent plane leaves outward.
template <class Real>
TANDEM_HD SpawnedRay<Real> spawn_ray(const SurfacePoint<Real>& from, const Vec3<Real>& direction) {
    const Double<Real> outward = dot(widen(direction), from.normal);
    return {{from.position, direction}, {from.primitive, outward < Double<Real>(0.0)}};
}

/// A shadow ray, for Tracer::occluded(). Its light is at t = 1.
template <class Real>
struct ShadowRay {
    Ray<Real> ray;
    ShadowSource<Real> source;
    Double<Real> t_max = Double<Real>(1.0);
    Mask<Real> active;  ///< false where the light is at the very point: such a ray has no direction, and brings no light
};

/// The shadow ray to a point of a light. `light`: the light's own primitive, or no_primitive.
template <class Real>
TANDEM_HD ShadowRay<Real> spawn_shadow_ray(const SurfacePoint<Real>& from, const Vec3<Real>& to,
                                           const UInt<Real>& light) {
    const SpawnedRay<Real> spawned = spawn_ray(from, to_real<Real>(widen(to) - widen(from.position)));
    ShadowRay<Real> shadow;
    shadow.ray = spawned.ray;
    static_cast<Source<Real>&>(shadow.source) = spawned.source;
    shadow.source.light = light;
    shadow.active = is_traceable(spawned.ray);
    return shadow;
}

}  // namespace tandem
