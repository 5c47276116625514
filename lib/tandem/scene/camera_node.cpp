#include "tandem/scene/camera_node.h"

#include <fmt/format.h>

#include <cmath>

#include "tandem/base/error.h"

namespace tandem {

std::optional<std::size_t> find_camera(const Scene& scene, const std::string& name) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (node.camera && (name.empty() || node.name == name)) return i;
    }
    return std::nullopt;
}

std::string camera_names(const Scene& scene) {
    std::string names;
    for (const Node& node : scene.nodes) {
        if (node.camera) names += (names.empty() ? "'" : ", '") + node.name + "'";
    }
    return names.empty() ? "none" : names;
}

std::size_t camera_node(const Scene& scene, const std::string& name) {
    if (const auto found = find_camera(scene, name)) return *found;
    if (name.empty()) {
        throw InputError("the scene has no camera; add a node with one, or use frame_scene() (scene/framing.h)");
    }
    throw InputError(fmt::format("the scene has no camera '{}'; it has {}", name, camera_names(scene)));
}

std::optional<Matrix3> camera_axes(const Transform& world_from_node) {
    const Matrix3 axes = transpose(world_from_node.linear);
    const double handedness = determinant(world_from_node.linear);
    if (handedness == 0 || !std::isfinite(handedness)) return std::nullopt;
    const Vec3d backward = normalize(axes.row[2]);
    const Vec3d right = normalize(cross(axes.row[1], backward)) * (handedness < 0 ? -1.0 : 1.0);
    const Vec3d up = normalize(cross(backward, right)) * (handedness < 0 ? -1.0 : 1.0);
    return Matrix3{{right, up, backward}};
}

}  // namespace tandem
