/// A scene whose rays are expensive.
#pragma once

#include "tandem/scene/scene.h"

namespace tandem::test {

/// `count` spheres, slightly displaced, and a camera (node 0) that sees the bounds of all of them in every pixel of a
/// film that is twice as wide as high.
inline Scene crowded_scene(int count) {
    Scene scene;
    scene.materials.emplace_back();
    Node camera{.name = "camera", .camera = OrthographicCamera{.ymag = 0.25}};
    camera.trs.translation = {0, 0, 10};
    scene.nodes.push_back(camera);
    Geometry spheres{.shape = SphereShape{}};
    for (int i = 0; i < count; ++i) {
        Trs aside;
        aside.translation = {0.1F * static_cast<float>(i) / static_cast<float>(count), 0, 0};
        spheres.instances.push_back(aside);
    }
    Node crowd{.name = "crowd"};
    if (count > 0) crowd.geometry.push_back(spheres);
    scene.nodes.push_back(crowd);
    return scene;
}

}  // namespace tandem::test
