#include "baseline/raster_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tandem/base/error.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/scene/icosphere.h"

namespace tandem::bench {

namespace {

constexpr std::size_t most_triangles = 4'000'000;
constexpr int finest_level = 6;
constexpr double most_pixels_off = 0.1;
/// How far the middle of an icosahedron's face is inside the sphere, in radii. Each level quarters it.
constexpr double depth_of_face = 0.2054;
/// The distance of the near plane, as a share of the scene's extent. Depth is a double, so it may be this small.
constexpr double near_share = 1e-6;

/// 20 * 4^level.
constexpr std::size_t faces_of(int level) { return std::size_t{20} << (2 * level); }

/// Adds up the triangles of all primitives; `level_of` says how fine a sphere of a radius at a point is.
template <class LevelOf>
std::size_t count_triangles(const PreparedScene& scene, LevelOf level_of) {
    std::size_t count =
        12 * (scene.boxes.size() + scene.parallelepipeds.size()) + scene.triangles.size() + 2 * scene.quads.size();
    for (const Sphere& sphere : scene.spheres) count += faces_of(level_of(widen(sphere.centre), sphere.radius));
    for (const Ellipsoid& body : scene.ellipsoids) {
        count += faces_of(level_of(body.centre, body.bounding_sphere.radius));
    }
    return count;
}

/// The largest number of pixels that a metre covers at a point.
double pixels_per_metre(const CameraView& camera, const Vec3d& point, double radius) {
    if (camera.orthographic) return 1 / std::sqrt(dot(camera.origin_dx, camera.origin_dx));
    const Vec3d offset = point - camera.origin;
    const double distance = std::max(std::sqrt(dot(offset, offset)) - radius, 1e-3 * radius);
    return 1 / (distance * std::sqrt(dot(camera.direction_dx, camera.direction_dx)));
}

/// The lowest level that keeps a sphere within most_pixels_off, or `finest`.
int level_of_detail(const CameraView& camera, const Vec3d& centre, double radius, int finest) {
    const double pixels = radius * pixels_per_metre(camera, centre, radius);
    int level = 0;
    for (double off = pixels * depth_of_face; off > most_pixels_off && level < finest; off /= 4) ++level;
    return level;
}

RasterMaterial plain_material(const PreparedScene& scene, std::size_t i) {
    const PhongMaterial& phong = scene.materials[i];
    const Optics& optics = scene.optics[i];
    float scattered = 1 - optics.transmission;
    Vec3f specular = phong.specular;
    if (!scene.microfacets.empty() && scene.microfacets[i].is_there != 0) {
        scattered *= 1 - scene.microfacets[i].metallic;
        specular = {0, 0, 0};
    }
    return {phong.ambient * scattered, phong.diffuse * scattered, specular, phong.shininess, optics.emission};
}

class Tessellation {
  public:
    Tessellation(const PreparedScene& scene, RasterScene& result, int finest)
        : scene_(scene), result_(result), finest_(finest) {}

    /// In the order of primitives.def, which is that of the ids.
    void add_all() {
        for (const Sphere& sphere : scene_.spheres) {
            const Vec3d centre = widen(sphere.centre);
            const double radius = sphere.radius;
            add_sphere(
                level_of_detail(result_.camera, centre, radius, finest_), false,
                [&](const Vec3d& unit) { return centre + unit * radius; }, [](const Vec3d& unit) { return unit; });
        }
        for (const Box& box : scene_.boxes) {
            const Vec3f corners[2] = {box.lower, box.upper};
            add_cube(
                false,
                [&](int x, int y, int z) {
                    return Vec3f{corners[x].x, corners[y].y, corners[z].z};
                },
                [](const Vec3d& axis) { return axis; });
        }
        for (const Ellipsoid& body : scene_.ellipsoids) {
            const Matrix3 linear = inverse(body.object_from_world);
            add_sphere(
                level_of_detail(result_.camera, body.centre, body.bounding_sphere.radius, finest_),
                determinant(linear) < 0, [&](const Vec3d& unit) { return body.centre + linear * unit; },
                [&](const Vec3d& unit) { return normalize(transpose(body.object_from_world) * unit); });
        }
        for (const Parallelepiped& body : scene_.parallelepipeds) {
            const Matrix3 linear = inverse(body.object_from_world);
            const auto side = [](int i) { return i == 0 ? -1.0 : 1.0; };
            add_cube(
                determinant(linear) < 0,
                [&](int x, int y, int z) {
                    return narrow(body.centre + linear * Vec3d{side(x), side(y), side(z)});
                },
                [&](const Vec3d& axis) { return normalize(transpose(body.object_from_world) * axis); });
        }
        for (const Triangle& face : scene_.triangles) {
            add_face({face.v0, face.v1, face.v2}, face.attributes, {0, 1, 2});
            ++primitive_;
        }
        for (const Quad& face : scene_.quads) {
            add_face({face.v0, face.v1, face.v2}, face.attributes, {0, 1, 2});
            add_face({face.v0, face.v2, face.v3}, face.attributes, {0, 2, 3});
            ++primitive_;
        }
    }

  private:
    /// `mirrored`: the placement reverses the order of the corners.
    void add(RasterTriangle triangle, bool mirrored) {
        triangle.material = scene_.material_of[primitive_];
        if (mirrored) {
            std::swap(triangle.corners[1], triangle.corners[2]);
            std::swap(triangle.normals[1], triangle.normals[2]);
        }
        result_.triangles.push_back(triangle);
    }

    template <class Place, class Normal>
    void add_sphere(int level, bool mirrored, Place place, Normal normal) {
        Mesh& mesh = spheres_[static_cast<std::size_t>(level)];
        if (mesh.positions.empty()) mesh = icosphere(level);
        for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
            RasterTriangle triangle;
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const Vec3d unit = widen(mesh.positions[mesh.triangles[i + corner]]);
                triangle.corners[corner] = narrow(place(unit));
                triangle.normals[corner] = narrow(normal(unit));
            }
            add(triangle, mirrored);
        }
        ++primitive_;
    }

    template <class Place, class Normal>
    void add_cube(bool mirrored, Place place, Normal normal) {
        for (int axis = 0; axis < 3; ++axis) {
            for (int side = 0; side < 2; ++side) {
                Vec3d outward{0, 0, 0};
                outward[axis] = side == 0 ? -1 : 1;
                const Vec3f facing = narrow(normal(outward));
                Vec3f corners[4];
                for (int i = 0; i < 4; ++i) {
                    int at[3];
                    at[axis] = side;
                    at[(axis + 1) % 3] = i == 1 || i == 2 ? 1 : 0;
                    at[(axis + 2) % 3] = i >= 2 ? 1 : 0;
                    corners[i] = place(at[0], at[1], at[2]);
                }
                const bool turned = (side == 0) != mirrored;
                add({{corners[0], corners[1], corners[2]}, {facing, facing, facing}}, turned);
                add({{corners[0], corners[2], corners[3]}, {facing, facing, facing}}, turned);
            }
        }
        ++primitive_;
    }

    /// `which`: the face's corners, for their normals.
    void add_face(const std::array<Vec3f, 3>& corners, const FaceAttributes& attributes,
                  const std::array<std::uint32_t, 3>& which) {
        RasterTriangle triangle;
        triangle.sides = attributes.sides;
        const Vec3f own = narrow(triangle_normal(corners[0], corners[1], corners[2]));
        for (std::size_t i = 0; i < 3; ++i) {
            triangle.corners[i] = corners[i];
            triangle.normals[i] =
                attributes.normals == no_attributes ? own : scene_.normals[attributes.normals + which[i]];
        }
        add(triangle, false);
    }

    const PreparedScene& scene_;
    RasterScene& result_;
    int finest_;
    std::size_t primitive_ = 0;
    std::array<Mesh, finest_level + 1> spheres_{};
};

/// Half the diagonal of the box around all corners, and of the camera.
double extent_of(const RasterScene& scene) {
    Vec3f low = narrow(scene.camera.origin), high = low;
    for (const RasterTriangle& triangle : scene.triangles) {
        for (const Vec3f& corner : triangle.corners) {
            for (int axis = 0; axis < 3; ++axis) {
                low[axis] = std::min(low[axis], corner[axis]);
                high[axis] = std::max(high[axis], corner[axis]);
            }
        }
    }
    const Vec3d diagonal = widen(high) - widen(low);
    return 0.5 * std::sqrt(dot(diagonal, diagonal));
}

}  // namespace

std::string why_not_rasterised(const PreparedScene& scene) {
    if (!scene.instances.empty()) return "the scene has instances of meshes, which the rasteriser does not draw";
    const std::size_t count = count_triangles(scene, [](const Vec3d&, double) { return 0; });
    if (count <= most_triangles) return {};
    return fmt::format("the scene has {} triangles even with the coarsest spheres; the rasteriser draws at most {}",
                       count, most_triangles);
}

RasterScene make_raster_scene(const PreparedScene& scene, int width, int height) {
    if (const std::string reason = why_not_rasterised(scene); !reason.empty()) throw EnvironmentError(reason);
    RasterScene result;
    result.camera = camera_view(scene.camera, width, height);
    result.lights = scene.lights;
    result.environment = scene.environment;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) result.materials.push_back(plain_material(scene, i));
    const auto count = [&](int finest) {
        return count_triangles(scene, [&](const Vec3d& centre, double radius) {
            return level_of_detail(result.camera, centre, radius, finest);
        });
    };
    int finest = finest_level;
    while (finest > 0 && count(finest) > most_triangles) --finest;
    result.triangles.reserve(count(finest));
    Tessellation(scene, result, finest).add_all();
    result.near = near_share * extent_of(result);
    return result;
}

}  // namespace tandem::bench
