/// A scene somewhere else, and of another size.
#pragma once

#include "tandem/scene/scene.h"

namespace tandem::test {

/// The scene under one more node, which moves and scales everything in it; animation goes on below it. Metres.
inline Scene under_parent(Scene scene, const Vec3d& translation, double scale) {
    const auto parent = static_cast<std::int32_t>(scene.nodes.size());
    for (Node& node : scene.nodes) {
        if (node.parent == Node::no_parent) node.parent = parent;
    }
    scene.nodes.push_back({.name = "elsewhere", .trs = {translation, {}, {scale, scale, scale}}});
    return scene;
}

}  // namespace tandem::test
