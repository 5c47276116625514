/// Where the space that is rendered in has its origin.
#pragma once

#include "tandem/scene/scene.h"

namespace tandem {

/// Floats are dense near zero, so the coordinates that kernels see should be small where the picture is sharp: near the
/// surface that is nearest to the camera. This finds it.
///
/// The rule: the point of a surface that is nearest to the camera, rounded to a grid, whose step is the largest power
/// of two up to 16 times the smaller of two lengths: the distance of that point from the camera, and the extent of the
/// scene. So every point of a surface has coordinates of at most 16 times its distance from the camera, and rounding
/// them to float moves it by an angle of at most 16 u = 9.6e-7, wherever in the world the scene is. A scene that lies
/// around the world's origin as seen from its camera stays where it is. Scaling a scene by a power of two scales the
/// origin. Tested by tests/compile/render_origin_test.cpp.
class RenderOrigin {
  public:
    explicit RenderOrigin(const Vec3d& camera) : camera_(camera) {}

    // World space, metres. Of an ellipsoid, the point towards the centre stands for the nearest one.
    void add_sphere(const Vec3d& centre, double radius);
    void add_box(const Vec3d& lower, const Vec3d& upper);
    /// The unit sphere, or the cube [-1, 1]^3, under an invertible transform.
    void add_placed(const Transform& world_from_unit, const Matrix3& unit_from_world, bool is_box);
    void add_mesh(const Mesh& mesh, const Transform& world_from_object);
    void add_triangle(const Vec3d& v0, const Vec3d& v1, const Vec3d& v2);
    /// Something that has coordinates but no surface: a light.
    void add_point(const Vec3d& point);

    /// {0, 0, 0} if there is no surface, or if coordinates from elsewhere would pass coordinate_limit.
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
