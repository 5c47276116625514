#include "tandem/scene/surface_reach.h"

#include <algorithm>
#include <cmath>

#include "tandem/base/parallel.h"
#include "tandem/scene/animation.h"

namespace tandem {

namespace {

constexpr std::size_t shapes_at_once = 4096;

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
    : world_from_node_(world_from_nodes(scene, time)), corners_(scene.meshes.size()) {
    for (std::size_t node = 0; node < scene.nodes.size(); ++node) {
        for (const Geometry& geometry : scene.nodes[node].geometry) {
            if (const auto* reference = std::get_if<MeshShape>(&geometry.shape)) {
                std::vector<Vec3f>& corners = corners_[reference->mesh];
                if (corners.empty()) corners = used_corners(scene.meshes[reference->mesh]);
                if (corners.empty()) continue;
            }
            shapes_.push_back({&geometry, node, count_});
            count_ += instance_count(geometry);
        }
    }
    // usually the first ones decide
    for (std::size_t begin = 0; is_empty_ && begin < count_; begin += shapes_at_once) {
        visit_instances(shapes_, world_from_node_, begin, std::min(begin + shapes_at_once, count_),
                        [&](const InstanceRange&, const Transform& world_from_shape) {
                            is_empty_ = is_empty_ && leaves_no_area(world_from_shape.linear);
                        });
    }
}

std::vector<double> SurfaceReach::along(std::span<const Vec3d> directions) const {
    std::vector<std::vector<double>> most_of(chunk_count(count_, shapes_at_once),
                                             std::vector<double>(directions.size(), -__builtin_huge_val()));
    for_each_chunk(count_, shapes_at_once, [&](const Chunk& chunk) {
        std::vector<double>& most = most_of[chunk.number];
        visit_instances(shapes_, world_from_node_, chunk.begin, chunk.end,
                        [&](const InstanceRange& shape, const Transform& world_from_shape) {
                            if (leaves_no_area(world_from_shape.linear)) return;
                            const Matrix3 columns = transpose(world_from_shape.linear);
                            for (std::size_t i = 0; i < directions.size(); ++i) {
                                const double start = dot(directions[i], world_from_shape.translation);
                                const double reach = reach_of(shape.geometry->shape, corners_, columns * directions[i]);
                                most[i] = std::max(most[i], start + reach);
                            }
                        });
    });
    std::vector<double> most(directions.size(), -__builtin_huge_val());
    for (const std::vector<double>& of_chunk : most_of) {
        for (std::size_t i = 0; i < most.size(); ++i) most[i] = std::max(most[i], of_chunk[i]);
    }
    return most;
}

}  // namespace tandem
