#include "tandem/scene/motion.h"

#include <algorithm>

#include "tandem/math/fp_environment.h"
#include "tandem/scene/animation.h"

namespace tandem {

namespace {

bool has_primitives(const Scene& scene, const Node& node) {
    return std::any_of(node.geometry.begin(), node.geometry.end(), [&](const Geometry& geometry) {
        const auto* shape = std::get_if<MeshShape>(&geometry.shape);
        if (shape == nullptr) return true;
        const Mesh& mesh = scene.meshes[shape->mesh];
        return !mesh.triangles.empty() || !mesh.quads.empty();
    });
}

}  // namespace

std::vector<std::size_t> nodes_in_motion(const Scene& scene, std::size_t camera, double time) {
    const DefaultFpEnvironment guard;
    const Shutter& shutter = shutter_of(*scene.nodes[camera].camera);
    if (!is_open(shutter)) return {};
    std::vector<bool> moves(scene.nodes.size(), false);
    for (const AnimationChannel& channel : scene.animation) {
        if (changes_between(channel, time + shutter.open, time + shutter.close)) moves[channel.node] = true;
    }
    bool is_empty = true;  // then no light matters
    for (const std::size_t i : parents_first(scene)) {
        const Node& node = scene.nodes[i];
        if (node.parent != Node::no_parent && moves[static_cast<std::size_t>(node.parent)]) moves[i] = true;
        if (has_primitives(scene, node)) is_empty = false;
    }
    std::vector<std::size_t> found;
    if (moves[camera]) found.push_back(camera);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        if (!moves[i] || i == camera) continue;
        const Node& node = scene.nodes[i];
        const bool shines = node.light && is_lit(*node.light) && !is_empty;
        if (shines || has_primitives(scene, node)) found.push_back(i);
    }
    return found;
}

}  // namespace tandem
