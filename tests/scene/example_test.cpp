/// The example of docs/scene-format.md, compiled. A test in tests/gltf compares the two texts.
#include <gtest/gtest.h>

#include "tandem/compile/prepared_scene.h"

// [example]
#include "tandem/compile/prepare.h"

tandem::Scene two_balls() {
    tandem::Scene scene;
    scene.materials = {{"clay", {{0.08F, 0.04F, 0.03F}, {0.8F, 0.4F, 0.3F}, {0.2F, 0.2F, 0.2F}, 16}}};
    tandem::Node eye{.name = "eye", .trs = {.translation = {0, 0, 4}}, .camera = tandem::PerspectiveCamera{0.8}};
    tandem::Node lamp{.name = "lamp", .trs = {.translation = {2, 3, 4}}, .light = tandem::LightSource{}};
    tandem::Node balls{.name = "balls"};
    balls.geometry = {{tandem::SphereShape{0.5}, 0, {{.translation = {-1, 0, 0}}, {.translation = {1, 0, 0}}}}};
    scene.nodes = {eye, lamp, balls};
    return scene;
}
// [example]

namespace tandem {
namespace {

TEST(Example, MakesTwoSpheres) {
    const auto prepared = prepare(two_balls());
    ASSERT_EQ(prepared.spheres.size(), 2U);
    EXPECT_EQ(prepared.spheres[1].centre, Vec3f(1, 0, 0));
}

}  // namespace
}  // namespace tandem
