/// Intersections and normals of the oracle, in x87 extended precision (64-bit significand).
#pragma once

#include <numbers>
#include <optional>

#include "tandem/kernel/view/scene_view.h"

namespace tandem::oracle {

using Real = long double;

inline constexpr Real pi = std::numbers::pi_v<Real>;

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

/// The surface at a crossing.
struct SurfaceHit {
    Real t;
    Vector normal;          ///< unit, outward; for a face the shading normal
    Vector facet{0, 0, 0};  ///< for a face its geometric normal, unit; for other shapes hit_primitive() copies `normal`
    // for a face: the numbers of the triangle's corners in it, and their barycentric weights
    std::uint32_t corner[3] = {0, 0, 0};
    Vector weight{0, 0, 0};
    FaceSides sides = FaceSides::single_sided;
};

/// The start of a ray: anywhere, or on the surface of the solid, on its way out or in; or anywhere, to find the second
/// crossing.
enum class Start { anywhere, leaving_outward, leaving_inward, before_first };

/// The nearest crossing in front of the origin. A ray that leaves the solid outward has none; one that leaves its
/// surface inward crosses the far side, at the smallest t there is if rounding has moved the origin beyond it.
[[nodiscard]] std::optional<SurfaceHit> hit_sphere(const Vector& centre, Real radius, const Line& line, Start start);
[[nodiscard]] std::optional<SurfaceHit> hit_box(const Vector& lower, const Vector& upper, const Line& line,
                                                Start start);
/// `is_box`: the cube [-1, 1]^3 under the placement, else the unit sphere.
[[nodiscard]] std::optional<SurfaceHit> hit_placed(const Placement& placement, bool is_box, const Line& line,
                                                   Start start);
/// A triangle of a face: three of its corners, and their numbers.
struct FaceCorners {
    Vec3f position[3];
    std::uint32_t number[3];
};

/// A line in the plane of the triangle misses. Signs are exact, and t is the long double nearest to the exact one,
/// unless the coordinates differ by more than a factor of about 2^30. `normals`: those of the scene.
[[nodiscard]] std::optional<SurfaceHit> hit_face(const FaceCorners& corners, const FaceAttributes& attributes,
                                                 const Vec3f* normals, const Line& line);
/// Any primitive of a scene, with its shading normal. A flat primitive is not hit by a line that leaves it.
[[nodiscard]] std::optional<SurfaceHit> hit_primitive(const SceneView& scene, std::uint32_t id, const Line& line,
                                                      Start start);

}  // namespace tandem::oracle
