/// Chooses the origin of render space.
#pragma once

#include "tandem/scene/scene.h"

namespace tandem {

/// Floats are dense near zero, so coordinates should be small where the image shows most detail: near the surface point
/// that is nearest to the camera.
///
/// The rule: the origin is that point, rounded to a grid. The step of the grid is the largest power of two up to 16
/// times the smaller of two lengths: the distance of the point from the camera, and the extent of the scene. So every
/// surface point has coordinates of at most 16 times its distance from the camera, and rounding them to float moves it
/// by an angle of at most 16 u = 9.6e-7, wherever in the world the scene is. A scene around the world's origin, as seen
/// from its camera, stays in place. Scaling a scene by a power of two scales the origin. Tested by
/// tests/compile/render_origin_test.cpp.
class RenderOrigin {
  public:
    explicit RenderOrigin(const Vec3d& camera) : camera_(camera) {}

    // World space, metres. For an ellipsoid, the point towards its centre replaces the nearest one.
    void add_sphere(const Vec3d& centre, double radius);
    void add_box(const Vec3d& lower, const Vec3d& upper);
    /// The unit sphere, or the cube [-1, 1]^3, under an invertible transform.
    void add_placed(const Transform& world_from_unit, const Matrix3& unit_from_world, bool is_box);
    void add_mesh(const Mesh& mesh, const Transform& world_from_object);
    void add_triangle(const Vec3d& v0, const Vec3d& v1, const Vec3d& v2);
    /// A box that contains a surface, which is not nearer to the camera than distance().
    void add_far(const Vec3d& lower, const Vec3d& upper) { add_extent(lower, upper); }
    /// From the camera to the nearest surface point so far; infinite if there is none.
    [[nodiscard]] double distance() const { return distance_; }
    /// A point without a surface: the position of a light.
    void add_point(const Vec3d& point);
    /// Adds everything that was added to another origin with the same camera, as if after the points of this one: of
    /// two points at the same distance the first counts.
    void add(const RenderOrigin& other);

    /// {0, 0, 0} if there is no surface, or if coordinates relative to another origin would exceed coordinate_limit.
    [[nodiscard]] Vec3d get() const;

  private:
    void add_candidate(const Vec3d& point, double distance);
    void add_extent(const Vec3d& lower, const Vec3d& upper);

    Vec3d camera_;
    Vec3d nearest_{0, 0, 0};
    double distance_ = __builtin_huge_val();
    Vec3d lower_{__builtin_huge_val(), __builtin_huge_val(), __builtin_huge_val()};
    Vec3d upper_ = -lower_;
    double reach_ = 0;  ///< largest magnitude of a coordinate
};

}  // namespace tandem
