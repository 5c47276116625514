#include "tandem/compile/crossed_boxes.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

template <class Estimate>
double estimate(const char* name, const Estimate& of) {
    const PreparedScene prepared = prepare(named_scene(name));
    const SceneView scene = view(prepared);
    Aabb all;
    for (std::uint32_t id = 0; id < primitive_count(scene); ++id) all = merge(all, primitive_bounds(scene, id));
    return of(scene, all);
}
double crossed(const char* name) { return estimate(name, crossed_boxes); }

TEST(CrossedBoxes, AreManyAmongLooseTrianglesAndMoreAmongHair) {
    EXPECT_EQ(crossed("spheres/1000"), 0);
    EXPECT_NEAR(crossed("icosphere/6"), 4, 1);
    const double loose = crossed("triangles/20000"), more = crossed("triangles/160000");
    EXPECT_NEAR(more / loose, 2, 0.2);  // with the cube root of their number
    EXPECT_GT(crossed("hair/20000"), 10 * loose);
}

TEST(BoxesBeforeAHit, AreFewerWhereTrianglesAreHit) {
    EXPECT_NEAR(crossed("icosphere/6") / estimate("icosphere/6", boxes_before_a_hit), 1 + std::numbers::pi / 3, 0.1)
        << "4 pi r^2 over half the area of the box, 12 r^2";
    EXPECT_GT(estimate("hair/20000", boxes_before_a_hit), 0.9 * crossed("hair/20000"));
    EXPECT_EQ(estimate("spheres/1000", boxes_before_a_hit), 0);
}

TEST(CrossedBoxes, OfOneBoxIsItsShare) {
    // rays of all directions that hit the larger box: a quarter of them hit one of half the size
    const Triangle triangle{{0, 0, 0}, {1, 0, 1}, {0, 1, 1}};
    SceneView scene{};
    scene.triangles = &triangle;
    scene.triangle_count = 1;
    EXPECT_DOUBLE_EQ(crossed_boxes(scene, {{0, 0, 0}, {2, 2, 2}}), 0.25);
}

}  // namespace
}  // namespace tandem
