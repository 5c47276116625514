/// The oracle's own intersections and normals, in x87 extended precision (64-bit significand).
#pragma once

#include <optional>

#include "tandem/kernel/view/scene_view.h"

namespace tandem::oracle {

using Real = long double;

struct Vector {
    Real x, y, z;
};

inline Vector to_vector(const Vec3f& v) { return {v.x, v.y, v.z}; }
inline Vector to_vector(const Vec3d& v) { return {v.x, v.y, v.z}; }
inline Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator*(const Vector& a, Real s) { return {a.x * s, a.y * s, a.z * s}; }
inline Real inner(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] Vector unit(const Vector& a);

inline Vector times(const Vector& a, const Vector& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

struct Line {
    Vector origin, direction;
};

/// What lies at a crossing.
struct SurfaceHit {
    Real t;
    Vector normal;          ///< unit, outward; of a face the one for shading
    Vector facet{0, 0, 0};  ///< of a face its own, unit; of other shapes hit_primitive() puts `normal` there
    // of a face: the triangle's corners by their number in it, and what each of them weighs
    std::uint32_t corner[3] = {0, 0, 0};
    Vector weight{0, 0, 0};
    FaceSides sides = FaceSides::single_sided;
};

/// Where a ray starts: anywhere, or on the surface of the body itself, on its way out or in; or anywhere, but its
/// second crossing is asked for.
enum class Start { anywhere, leaving_outward, leaving_inward, before_first };

/// The nearest crossing in front of the origin. One that leaves the body outward has none; one that leaves it inward
/// has its far side, at the smallest t there is if rounding has put the origin behind that.
[[nodiscard]] std::optional<SurfaceHit> hit_sphere(const Vector& centre, Real radius, const Line& line, Start start);
[[nodiscard]] std::optional<SurfaceHit> hit_box(const Vector& lower, const Vector& upper, const Line& line,
                                                Start start);
/// `is_box`: the cube [-1, 1]^3 under the placement, else the unit sphere.
[[nodiscard]] std::optional<SurfaceHit> hit_placed(const Placement& placement, bool is_box, const Line& line,
                                                   Start start);
/// A triangle of a face: three of its corners, and their numbers in it.
struct FaceCorners {
    Vec3f position[3];
    std::uint32_t number[3];
};

/// A line in the plane of the triangle misses. Signs are exact, and t is the long double nearest to the exact one, if
/// the coordinates do not differ by more than 2^30 or so. `normals`: of the scene.
[[nodiscard]] std::optional<SurfaceHit> hit_face(const FaceCorners& corners, const FaceAttributes& attributes,
                                                 const Vec3f* normals, const Line& line);
/// Any primitive of a scene, with its normal for shading. A flat one that the line leaves is not met again.
[[nodiscard]] std::optional<SurfaceHit> hit_primitive(const SceneView& scene, std::uint32_t id, const Line& line,
                                                      Start start);

}  // namespace tandem::oracle
