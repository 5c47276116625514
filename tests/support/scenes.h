/// Small scenes that the tests change.
#pragma once

#include "support/input_error.h"
#include "tandem/compile/prepare.h"
#include "tandem/scene/scene.h"

namespace tandem::test {

/// A scene with a bit of everything: a camera, a sphere of radius 1 at the node "body", a light, an animated node.
inline Scene small_scene() {
    Scene scene;
    scene.name = "small";
    scene.materials = {{"plain", {}}};
    scene.nodes.resize(3);
    scene.nodes[0].name = "eye";
    scene.nodes[0].camera = PerspectiveCamera{1.0};
    scene.nodes[1].name = "body";
    scene.nodes[1].geometry = {{SphereShape{1}, 0, {}}};
    scene.nodes[2].name = "lamp";
    scene.nodes[2].light = LightSource{};
    AnimationChannel channel;
    channel.node = 2;
    channel.times = {0, 1, 3};
    channel.values = {0, 0, 0, 2, 4, 6, 4, 4, 4};
    scene.animation = {channel};
    return scene;
}

}  // namespace tandem::test
