/// Moves and scales a whole scene.
#pragma once

#include "tandem/scene/scene.h"

namespace tandem::test {

/// The scene under an additional node, which moves and scales everything, including its animation. Metres.
inline Scene under_parent(Scene scene, const Vec3d& translation, double scale) {
    const auto parent = static_cast<std::int32_t>(scene.nodes.size());
    for (Node& node : scene.nodes) {
        if (node.parent == Node::no_parent) node.parent = parent;
    }
    scene.nodes.push_back({.name = "elsewhere", .trs = {translation, {}, {scale, scale, scale}}});
    return scene;
}

}  // namespace tandem::test
