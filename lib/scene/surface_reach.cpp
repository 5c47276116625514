#include "tandem/scene/surface_reach.h"

#include <algorithm>
#include <cmath>

#include "tandem/scene/animation.h"

namespace tandem {

namespace {

/// Does it take every face to a line or a point?
bool leaves_no_area(const Matrix3& m) {
    const Vec3d zero{0, 0, 0};
    return cross(m.row[0], m.row[1]) == zero && cross(m.row[1], m.row[2]) == zero && cross(m.row[2], m.row[0]) == zero;
}

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

}  // namespace

std::vector<PlacedShape> place_shapes(const Scene& scene, double time) {
    const std::vector<Transform> world_from_node = world_from_nodes(scene, time);
    std::vector<PlacedShape> placed;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        for (const Geometry& geometry : scene.nodes[i].geometry) {
            const auto add = [&](const Transform& world_from_shape) {
                if (!leaves_no_area(world_from_shape.linear)) placed.push_back({&geometry, world_from_shape});
            };
            if (geometry.instances.empty()) add(world_from_node[i]);
            for (const Trs& instance : geometry.instances) add(world_from_node[i] * to_transform(instance));
        }
    }
    return placed;
}

SurfaceReach::SurfaceReach(const Scene& scene, double time) : corners_(scene.meshes.size()) {
    for (const PlacedShape& placed : place_shapes(scene, time)) {
        const Shape& shape = placed.geometry->shape;
        if (const auto* reference = std::get_if<MeshShape>(&shape)) {
            std::vector<Vec3f>& corners = corners_[reference->mesh];
            if (corners.empty()) corners = used_corners(scene.meshes[reference->mesh]);
            if (corners.empty()) continue;
        }
        bodies_.push_back({placed.world_from_shape, &shape});
    }
}

double SurfaceReach::along(const Vec3d& direction) const {
    double most = -__builtin_huge_val();
    for (const Body& body : bodies_) {
        const double start = dot(direction, body.world_from_shape.translation);
        const Vec3d local = transpose(body.world_from_shape.linear) * direction;
        double reach = -__builtin_huge_val();
        if (const auto* sphere = std::get_if<SphereShape>(body.shape)) {
            reach = sphere->radius * std::sqrt(dot(local, local));
        } else if (const auto* box = std::get_if<BoxShape>(body.shape)) {
            reach = norm1(local * box->size) / 2;
        } else {
            for (const Vec3f& corner : corners_[std::get<MeshShape>(*body.shape).mesh]) {
                reach = std::max(reach, dot(local, widen(corner)));
            }
        }
        most = std::max(most, start + reach);
    }
    return most;
}

}  // namespace tandem
