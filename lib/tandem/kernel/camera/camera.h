/// Cameras: perspective, with a pinhole or a thin lens, and orthographic.
#pragma once

#include "tandem/kernel/sampler/warp.h"
#include "tandem/math/ray.h"

namespace tandem {

/// A camera set up for a film of a given size. A ray is affine in the film position (x, y), in pixels from the top
/// left corner, x to the right and y down:
///   origin(x, y) = origin + x origin_dx + y origin_dy, and the same for the direction.
/// Perspective: the origin steps are zero. Orthographic: the direction steps are zero. World space, metres, double;
/// computed once on the host (compile/prepare.h).
struct CameraView {
    Vec3d origin;
    Vec3d origin_dx;
    Vec3d origin_dy;
    Vec3d direction;
    Vec3d direction_dx;
    Vec3d direction_dy;
    bool orthographic;
    // for a thin lens, which orthographic cameras do not have
    bool has_lens = false;
    Vec3d lens_x{0, 0, 0}, lens_y{0, 0, 0};  ///< radius of the lens, to the right and upwards
    double inverse_focus = 0;                ///< 1 / depth of the focal plane, 1/metres
    double rotation = 0;                     ///< of the aperture's first corner, in turns
    std::int32_t blades = 0;                 ///< of the aperture; 0: round
};

/// The rays through a pixel: the one through its corner, and the steps that an offset adds to it.
template <class Real>
struct PixelRays {
    Vec3<Real> origin, direction;  ///< through the corner
    Vec3<Real> dx, dy;             ///< the steps of the origin if `orthographic`, else of the direction
    bool orthographic;

    /// The ray through an offset from the corner: in [0, 1)^2, or farther with a wide filter (sampler/pixel_filter.h).
    [[nodiscard]] TANDEM_HD_INLINE Ray<Real> at(const Real& offset_x, const Real& offset_y) const {
        const Vec3<Real> step = dx * offset_x + dy * offset_y;
        return orthographic ? Ray<Real>{origin + step, direction} : Ray<Real>{origin, direction + step};
    }
};

/// Directions are not normalised. The corner of the pixel is computed in double and rounded once; the offset is added
/// separately in float, so that it stays accurate on large films. Within 2 ulp of the largest component. (The tier
/// precise adds the offset in double; fast computes the corner in float.)
template <class Real>
TANDEM_HD_INLINE PixelRays<Real> rays_of_pixel(const CameraView& camera, const Double<Real>& pixel_x,
                                               const Double<Real>& pixel_y) {
    using D = Double<Real>;
    const auto corner = [&](const Vec3d& start, const Vec3d& dx, const Vec3d& dy) {
        return to_real<Real>(
            Vec3<D>{(constant<D>(start.x) + pixel_x * constant<D>(dx.x)) + pixel_y * constant<D>(dy.x),
                    (constant<D>(start.y) + pixel_x * constant<D>(dx.y)) + pixel_y * constant<D>(dy.y),
                    (constant<D>(start.z) + pixel_x * constant<D>(dx.z)) + pixel_y * constant<D>(dy.z)});
    };
    if (camera.orthographic) {
        return {corner(camera.origin, camera.origin_dx, camera.origin_dy), constant<Real>(camera.direction),
                constant<Real>(camera.origin_dx), constant<Real>(camera.origin_dy), true};
    }
    return {constant<Real>(camera.origin), corner(camera.direction, camera.direction_dx, camera.direction_dy),
            constant<Real>(camera.direction_dx), constant<Real>(camera.direction_dy), false};
}

/// Ray through film position (pixel + offset).
template <class Real>
TANDEM_HD_INLINE Ray<Real> camera_ray(const CameraView& camera, const Double<Real>& pixel_x,
                                      const Double<Real>& pixel_y, const Real& offset_x, const Real& offset_y) {
    return rays_of_pixel<Real>(camera, pixel_x, pixel_y).at(offset_x, offset_y);
}

/// The camera ray through the point of the lens that u and v in [0, 1) choose. All such rays converge in the focal
/// plane, since the directions of camera rays have depth 1.
/// Source: R. Cook, T. Porter, L. Carpenter, "Distributed Ray Tracing", SIGGRAPH 1984, sec. 3.2: the thin lens.
template <class Real>
TANDEM_HD_INLINE Ray<Real> through_lens(const CameraView& camera, const Ray<Real>& ray, const Real& u, const Real& v) {
    using D = Double<Real>;
    const Vec2<D> point = sample_aperture<Real>(camera.blades, constant<D>(camera.rotation), widen(u), widen(v));
    const Vec3<D> offset = constant<D>(camera.lens_x) * point.x + constant<D>(camera.lens_y) * point.y;
    const D inverse_focus = constant<D>(camera.inverse_focus);
    return {to_real<Real>(widen(ray.origin) + offset), to_real<Real>(widen(ray.direction) - offset * inverse_focus)};
}

}  // namespace tandem
