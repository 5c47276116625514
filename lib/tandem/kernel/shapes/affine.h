/// Spheres and boxes under an affine transform: an ellipsoid is the unit sphere and a parallelepiped the cube [-1, 1]^3
/// of its own space. The ray is transformed to that space; t is the same in both.
#pragma once

#include "tandem/kernel/shapes/box.h"
#include "tandem/kernel/shapes/sphere.h"
#include "tandem/math/transform.h"

namespace tandem {

/// Placement of a unit solid. World points map by object_from_world * (p - centre): subtracting first avoids
/// cancellation for a small solid far from the origin. The host computes the inverse in double.
struct Placement {
    Matrix3 object_from_world;  ///< linear part
    Vec3d centre;               ///< world space, metres
    Sphere bounding_sphere;     ///< encloses the solid; for the reject filter
    Vec3d half_extent;          ///< of its world-space bounding box, from the centre
    double unused = 0;          ///< otherwise padding bytes, undefined
};
static_assert(sizeof(Placement) == 72 + 24 + 16 + 24 + 8,
              "no byte of a placement is undefined; scene_hash() reads all");

/// The unit sphere and the cube [-1, 1]^3 under a placement.
struct Ellipsoid : Placement {};
struct Parallelepiped : Placement {};

TANDEM_HD_INLINE Aabb bounds(const Placement& placement) { return enclose(placement.centre, placement.half_extent); }

/// A ray in object space, double, not normalised.
template <class Real>
struct ObjectRay {
    Vec3<Double<Real>> origin;
    Vec3<Double<Real>> direction;
};

template <class Real>
TANDEM_HD_INLINE ObjectRay<Real> to_object(const Placement& placement, const Ray<Real>& ray) {
    using D = Double<Real>;
    const Vec3<D> offset = widen(ray.origin) - constant<D>(placement.centre);
    return {multiply(placement.object_from_world, offset), multiply(placement.object_from_world, widen(ray.direction))};
}

template <class Real>
TANDEM_HD_INLINE SphereRoots<Real> ellipsoid_roots(const Placement& placement, const Ray<Real>& ray,
                                                   const SphereLines<Real>& lines = {}) {
    const ObjectRay<Real> local = to_object(placement, ray);
    const Double<Real> zero(0.0);
    return sphere_roots<Real>(local.origin, {zero, zero, zero}, local.direction, Double<Real>(1.0), lines);
}

template <class Real>
TANDEM_HD_INLINE Crossing<Real> cross_ellipsoid(const Placement& placement, const Ray<Real>& ray) {
    return to_crossing(ellipsoid_roots(placement, ray));
}

template <class Real>
TANDEM_HD_INLINE BoxCrossing<Real> cross_parallelepiped(const ObjectRay<Real>& local) {
    using D = Double<Real>;
    const Vec3<D> one = {D(1.0), D(1.0), D(1.0)};
    return cross_box<Real>(-one, one, local.origin, local.direction);
}

/// The nearest hit in front of the ray's origin, in the lanes of `active`.
template <class Real>
TANDEM_HD_INLINE Mask<Real> first_hit(const Ellipsoid& body, const Ray<Real>& ray, Double<Real>& t,
                                      const Mask<Real>& active = Mask<Real>(true)) {
    return active && first_hit(ellipsoid_roots<Real>(body, ray, {active}), t);
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> first_hit(const Parallelepiped& body, const Ray<Real>& ray, Double<Real>& t,
                                      const Mask<Real>& active = Mask<Real>(true)) {
    return active && first_hit<Real>(cross_parallelepiped(to_object(body, ray)), t);
}

/// World-space unit normal from an object-space one: the inverse transpose of world_from_object.
template <class Real>
TANDEM_HD_INLINE Vec3<Double<Real>> to_world_normal(const Placement& placement,
                                                    const Vec3<Double<Real>>& object_normal) {
    return normalize(multiply(transpose(placement.object_from_world), object_normal));
}

// For closed solids `from_inside` follows from the ray's origin, so that a grazing ray enters before it leaves.
template <class Real>
TANDEM_HD_INLINE HitRecord<Real> record_hit(const Ellipsoid& body, const Ray<Real>& ray, const Double<Real>&,
                                            const Mask<Real>& exits, const Mask<Real>&) {
    const ObjectRay<Real> local = to_object(body, ray);
    return {UInt<Real>(0U), exits || dot(local.origin, local.origin) < Double<Real>(1.0)};
}
template <class Real>
TANDEM_HD_INLINE HitRecord<Real> record_hit(const Parallelepiped& body, const Ray<Real>& ray, const Double<Real>&,
                                            const Mask<Real>& exits, const Mask<Real>&) {
    const ObjectRay<Real> local = to_object(body, ray);
    return record_hit<Real>(cross_parallelepiped(local), local.direction, exits);
}

template <class Real>
TANDEM_HD_INLINE Vec3<Double<Real>> ellipsoid_normal(const Placement& placement, const Ray<Real>& ray,
                                                     const Double<Real>& t) {
    using D = Double<Real>;
    const ObjectRay<Real> local = to_object(placement, ray);
    return to_world_normal<Real>(placement,
                                 Vec3<D>{local.origin.x + t * local.direction.x, local.origin.y + t * local.direction.y,
                                         local.origin.z + t * local.direction.z});
}

template <class Real>
TANDEM_HD_INLINE Vec3<Double<Real>> parallelepiped_normal(const Placement& placement, const HitRecord<Real>& record) {
    return to_world_normal<Real>(placement, face_normal(record));
}

}  // namespace tandem
