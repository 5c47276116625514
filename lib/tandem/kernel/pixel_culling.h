/// Which of a few primitives the camera rays of a tile of pixels may hit, determined for all rays at once. So a tile of
/// background tests no primitive for its samples, however many there are.
///
/// Needs: a camera and primitives within coordinate_limit.
/// Gives: every primitive that a camera ray of the tile hits, and perhaps others.
/// Method: the rays differ little from the one through the tile's middle. The moment of a line about the primitive's
///         centre changes by at most |f| dd + do (|d| + dd), where f points from the centre to the middle ray's origin,
///         and do and dd bound how far origins and directions are from the middle ray's.
/// Bounds: all in double, whose rounding a relative margin of 2^-30 covers. Rays are rounded to float, by at most 2^-20
///         of the terms that camera_ray() adds.
#pragma once

#include "tandem/kernel/camera/camera.h"
#include "tandem/kernel/traversal/constant_memory_tracer.h"

namespace tandem {

/// The camera rays of a tile: origins and directions within the spreads, Euclidean lengths, of those of the middle.
struct RayBundle {
    Vec3d origin, direction;
    double origin_spread, direction_spread;
};

namespace culling_detail {

inline constexpr double camera_rounding = 0x1p-20;
inline constexpr double margin = 1.0 + 0x1p-30;

TANDEM_HD_INLINE double length_of(const Vec3d& a) { return square_root(dot(a, a)); }

}  // namespace culling_detail

/// Pixels of a film: `width` by `height` from (x, y) on.
struct PixelTile {
    std::uint32_t x, y, width, height;
    double reach = 0;  ///< how far outside them their samples may lie: reach_of() of the filter
};

/// `has_lens`: whether rays start on the camera's lens, if it has one.
TANDEM_HD_INLINE RayBundle bundle_of_tile(const CameraView& camera, const PixelTile& tile, bool has_lens) {
    using namespace culling_detail;
    const double width = tile.width + 2 * tile.reach, height = tile.height + 2 * tile.reach;
    const auto middle = [&](const Vec3d& start, const Vec3d& dx, const Vec3d& dy) {
        return start + dx * (tile.x + 0.5 * tile.width) + dy * (tile.y + 0.5 * tile.height);
    };
    const auto spread = [&](const Vec3d& start, const Vec3d& dx, const Vec3d& dy) {
        const double across = norm1(dx), down = norm1(dy);
        return 0.5 * (across * width + down * height) +
               camera_rounding * (norm1(start) + across * (tile.x + width) + down * (tile.y + height));
    };
    RayBundle bundle = {middle(camera.origin, camera.origin_dx, camera.origin_dy),
                        middle(camera.direction, camera.direction_dx, camera.direction_dy),
                        spread(camera.origin, camera.origin_dx, camera.origin_dy),
                        spread(camera.direction, camera.direction_dx, camera.direction_dy)};
    if (has_lens && camera.has_lens) {
        const double offset = norm1(camera.lens_x) + norm1(camera.lens_y);
        bundle.origin_spread += offset * (1 + camera_rounding);
        bundle.direction_spread += offset * camera.inverse_focus * (1 + camera_rounding);
    }
    return bundle;
}

TANDEM_HD_INLINE bool may_hit(const RayBundle& rays, const Sphere& sphere) {
    using namespace culling_detail;
    const Vec3d f = rays.origin - widen(sphere.centre);
    const double longest = length_of(rays.direction) + rays.direction_spread;
    const double change = length_of(f) * rays.direction_spread + rays.origin_spread * longest;
    // written so that NaN gives true
    return !(length_of(cross(f, rays.direction)) > (change + sphere.radius * longest) * margin);
}

/// Separating axes of a line and a box: direction x each axis.
TANDEM_HD_INLINE bool may_hit(const RayBundle& rays, const Box& box) {
    using namespace culling_detail;
    const Vec3d lower = widen(box.lower), upper = widen(box.upper);
    const Vec3d half = (upper - lower) * 0.5;
    const Vec3d f = rays.origin - (lower + upper) * 0.5;
    const double longest = length_of(rays.direction) + rays.direction_spread;
    const double change = length_of(f) * rays.direction_spread + rays.origin_spread * longest;
    const Vec3d moment = cross(f, rays.direction);
    const double x = absolute(rays.direction.x) + rays.direction_spread;
    const double y = absolute(rays.direction.y) + rays.direction_spread;
    const double z = absolute(rays.direction.z) + rays.direction_spread;
    const bool separated = absolute(moment.x) > (change + half.y * z + half.z * y) * margin ||
                           absolute(moment.y) > (change + half.z * x + half.x * z) * margin ||
                           absolute(moment.z) > (change + half.x * y + half.y * x) * margin;
    return !separated;
}

/// Whether a camera ray of the tile may hit the primitive in a slot of ConstantMemoryStructure, if there is one.
TANDEM_HD_INLINE bool may_hit(const ConstantMemoryStructure& few, const RayBundle& rays, std::uint32_t slot) {
    if (slot < ConstantMemoryStructure::max_spheres) {
        return slot < few.scene.sphere_count && may_hit(rays, few.spheres[slot]);
    }
    const std::uint32_t box = slot - ConstantMemoryStructure::max_spheres;
    return box < few.scene.box_count && may_hit(rays, few.faces[box]);
}

/// Traces camera rays among some of the primitives, and other rays among all.
struct CulledTracer {
    static constexpr std::uint32_t kinds = ConstantMemoryStructure::kinds;
    static constexpr bool has_hierarchy = false;

    const ConstantMemoryTracer& all;
    std::uint32_t slots;

    template <class Real, class From>
    TANDEM_HD_INLINE Closest<Real> closest(const Ray<Real>& ray, const From& source, bool active,
                                           const Double<Real>& farthest = no_hit<Real>().t) const {
        if constexpr (std::is_same_v<From, NoSource>) {
            Closest<Real> best = {farthest, no_primitive};
            if (active) all.find_among<Search::nearest>(slots, ray, source, best);
            return best;
        } else {
            return all.closest(ray, source, active, farthest);
        }
    }
    template <class Real, class From>
    TANDEM_HD_INLINE bool occluded(const Ray<Real>& ray, const Double<Real>& t_max, const From& source,
                                   bool active) const {
        return all.occluded(ray, t_max, source, active);
    }
};

}  // namespace tandem
