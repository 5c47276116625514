/// Cameras that send straight rays: pinhole (perspective) and orthographic.
#pragma once

#include "tandem/math/ray.h"

namespace tandem {

/// A camera set up for a film of a given size. A ray is affine in the film position (x, y), in pixels from the top
/// left corner, x to the right and y down:
///   origin(x, y) = origin + x origin_dx + y origin_dy, and the same for the direction.
/// Perspective: the origin steps are zero. Orthographic: the direction steps are zero. World space, metres, double;
/// made once on the host (scene/prepare.h).
struct CameraView {
    Vec3d origin;
    Vec3d origin_dx;
    Vec3d origin_dy;
    Vec3d direction;
    Vec3d direction_dx;
    Vec3d direction_dy;
    bool orthographic;
};

/// Ray through film position (pixel + offset); the offset within the pixel is in [0, 1)^2. Directions are not
/// normalised. The corner of the pixel comes from double, once per pixel; the offset is added in float, apart from
/// the pixel's number, so that a large film does not eat its digits. Within 2 ulp of the largest component. (In the
/// tier precise the offset is added in double, in fast the corner comes from float.)
template <class Real>
TANDEM_HD Ray<Real> camera_ray(const CameraView& camera, const Double<Real>& pixel_x, const Double<Real>& pixel_y,
                               const Real& offset_x, const Real& offset_y) {
    using D = Double<Real>;
    const auto at = [&](const Vec3d& start, const Vec3d& dx, const Vec3d& dy) {
        const auto corner =
            to_real<Real>(Vec3<D>{(constant<D>(start.x) + pixel_x * constant<D>(dx.x)) + pixel_y * constant<D>(dy.x),
                                  (constant<D>(start.y) + pixel_x * constant<D>(dx.y)) + pixel_y * constant<D>(dy.y),
                                  (constant<D>(start.z) + pixel_x * constant<D>(dx.z)) + pixel_y * constant<D>(dy.z)});
        return corner + (constant<Real>(dx) * offset_x + constant<Real>(dy) * offset_y);
    };
    Ray<Real> ray;
    ray.origin =
        camera.orthographic ? at(camera.origin, camera.origin_dx, camera.origin_dy) : constant<Real>(camera.origin);
    ray.direction = camera.orthographic ? constant<Real>(camera.direction)
                                        : at(camera.direction, camera.direction_dx, camera.direction_dy);
    return ray;
}

}  // namespace tandem
