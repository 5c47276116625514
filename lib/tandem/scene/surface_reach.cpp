#include "tandem/scene/surface_reach.h"

#include <algorithm>
#include <cmath>

#include "tandem/scene/animation.h"

namespace tandem {

namespace {

std::vector<Vec3f> used_corners(const Mesh& mesh) {
    std::vector<bool> used(mesh.positions.size(), false);
    for (const auto* indices : {&mesh.triangles, &mesh.quads}) {
        for (const std::uint32_t index : *indices) used[index] = true;
    }
    std::vector<Vec3f> corners;
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i]) corners.push_back(mesh.positions[i]);
    }
    return corners;
}

/// The support function of a shape around its own origin.
double reach_of(const Shape& shape, const std::vector<std::vector<Vec3f>>& corners, const Vec3d& direction) {
    if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
        return sphere->radius * std::sqrt(dot(direction, direction));
    }
    if (const auto* box = std::get_if<BoxShape>(&shape)) return norm1(direction * box->size) / 2;
    double most = -__builtin_huge_val();
    for (const Vec3f& corner : corners[std::get<MeshShape>(shape).mesh]) {
        most = std::max(most, dot(direction, widen(corner)));
    }
    return most;
}

}  // namespace

bool leaves_no_area(const Matrix3& map) {
    const Vec3d zero{0, 0, 0};
    return cross(map.row[0], map.row[1]) == zero && cross(map.row[1], map.row[2]) == zero &&
           cross(map.row[2], map.row[0]) == zero;
}

SurfaceReach::SurfaceReach(const Scene& scene, double time)
    : scene_(&scene), world_from_node_(world_from_nodes(scene, time)), corners_(scene.meshes.size()) {
    for_each_shape(scene, world_from_node_, [&](const Geometry& geometry, const Transform&) {
        if (const auto* reference = std::get_if<MeshShape>(&geometry.shape)) {
            std::vector<Vec3f>& corners = corners_[reference->mesh];
            if (corners.empty()) corners = used_corners(scene.meshes[reference->mesh]);
            if (corners.empty()) return;
        }
        is_empty_ = false;
    });
}

std::vector<double> SurfaceReach::along(std::span<const Vec3d> directions) const {
    std::vector<double> most(directions.size(), -__builtin_huge_val());
    for_each_shape(*scene_, world_from_node_, [&](const Geometry& geometry, const Transform& world_from_shape) {
        const Matrix3 columns = transpose(world_from_shape.linear);
        for (std::size_t i = 0; i < directions.size(); ++i) {
            const double start = dot(directions[i], world_from_shape.translation);
            most[i] = std::max(most[i], start + reach_of(geometry.shape, corners_, columns * directions[i]));
        }
    });
    return most;
}

}  // namespace tandem
