#include "tandem/scene/prepare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/scenes.h"

namespace tandem {
namespace {

using test::contains;
using test::input_error;
using test::small_scene;

Quaternion about_z(double radians) { return {0, 0, std::sin(radians / 2), std::cos(radians / 2)}; }

/// small_scene() with another thing at "body".
PreparedScene prepare_body(Shape shape, const Trs& trs) {
    Scene scene = small_scene();
    scene.nodes[1].geometry[0].shape = shape;
    scene.nodes[1].trs = trs;
    return prepare(scene);
}

TEST(Prepare, RotationAndUniformScaleKeepASphere) {
    const auto prepared = prepare_body(SphereShape{0.5}, {{1, 2, 3}, {0.1, 0.2, 0.3, 0.9}, {3, 3, 3}});
    ASSERT_EQ(prepared.spheres.size(), 1U);
    EXPECT_EQ(prepared.spheres[0].centre, Vec3f(1, 2, 3));
    EXPECT_EQ(prepared.spheres[0].radius, 1.5F);
}

TEST(Prepare, AMirroredSphereIsASphere) {
    EXPECT_EQ(prepare_body(SphereShape{1}, {{}, {}, {-2, 2, 2}}).spheres.size(), 1U);
}

TEST(Prepare, UnequalScaleMakesAnEllipsoid) {
    const auto prepared = prepare_body(SphereShape{0.5}, {{1, 2, 3}, {}, {2, 4, 6}});
    ASSERT_EQ(prepared.ellipsoids.size(), 1U);
    const Placement& placed = prepared.ellipsoids[0];
    EXPECT_EQ(placed.centre, Vec3d(1, 2, 3));
    EXPECT_NEAR(placed.half_extent.x, 1, 1e-14);
    EXPECT_NEAR(placed.half_extent.z, 3, 1e-14);
    EXPECT_DOUBLE_EQ(placed.object_from_world.row[1].y, 0.5);
    EXPECT_GE(placed.bounding_sphere.radius, 3);
}

TEST(Prepare, DiagonalTransformsKeepABox) {
    const auto prepared = prepare_body(BoxShape{{1, 2, 4}}, {{10, 0, 0}, {}, {-2, 1, 0.5}});
    ASSERT_EQ(prepared.boxes.size(), 1U);
    EXPECT_EQ(prepared.boxes[0].lower, Vec3f(9, -1, -1));
    EXPECT_EQ(prepared.boxes[0].upper, Vec3f(11, 1, 1));
}

TEST(Prepare, ARotatedBoxIsAParallelepiped) {
    const double quarter = std::numbers::pi / 4;
    const auto prepared = prepare_body(BoxShape{{2, 2, 2}}, {{0, 0, 5}, about_z(quarter), {1, 1, 1}});
    ASSERT_EQ(prepared.parallelepipeds.size(), 1U);
    EXPECT_NEAR(prepared.parallelepipeds[0].half_extent.x, std::sqrt(2), 1e-12);
    EXPECT_NEAR(prepared.parallelepipeds[0].half_extent.z, 1, 1e-12);
}

TEST(Prepare, ABoxMayBeFlatButNotWhenRotated) {
    EXPECT_EQ(prepare_body(BoxShape{{1, 0, 1}}, {}).boxes.size(), 1U);
    const Trs rotated{{}, about_z(0.3), {1, 1, 1}};
    EXPECT_TRUE(contains(input_error([&] {
                             (void)prepare_body(BoxShape{{1, 0, 1}}, rotated);
                         }),
                         "node 1 'body' has a rotated or sheared box that is flat"));
    EXPECT_TRUE(contains(input_error([&] {
                             (void)prepare_body(SphereShape{1}, {{}, {}, {1, 0, 1}});
                         }),
                         "node 1 'body' has a sphere that its transform flattens"));
}

TEST(Prepare, RefusesWhatIsTooFarOrTooSmallForFloats) {
    EXPECT_TRUE(contains(input_error([&] {
                             (void)prepare_body(SphereShape{6e17}, {{6e17, 0, 0}, {}, {1, 1, 1}});
                         }),
                         "farther than 1e18"));
    EXPECT_TRUE(contains(input_error([&] { (void)prepare_body(SphereShape{1e-50}, {}); }), "radius vanishes"));
}

TEST(Prepare, TransformsComposeDownTheTreeInAnyOrderOfNodes) {
    Scene scene = small_scene();
    scene.nodes[1].parent = 4;  // parents may come later
    scene.nodes.resize(5);
    scene.nodes[4].parent = 3;
    scene.nodes[4].trs = {{1, 0, 0}, {}, {2, 2, 2}};
    scene.nodes[3].matrix = Transform{{{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}}, {0, 0, 7}};  // a quarter turn about z
    scene.nodes[1].trs.translation = {3, 0, 0};
    const auto prepared = prepare(scene);
    ASSERT_EQ(prepared.spheres.size(), 1U);
    EXPECT_EQ(prepared.spheres[0].centre, Vec3f(0, 7, 7));
    EXPECT_EQ(prepared.spheres[0].radius, 2);
}

TEST(Prepare, MatrixReplacesTrs) {
    Scene scene = small_scene();
    scene.nodes[1].trs.translation = {9, 9, 9};
    scene.nodes[1].matrix = Transform{{{{2, 0, 0}, {0, 3, 0}, {0, 0, 4}}}, {1, 2, 3}};
    scene.nodes[1].geometry[0].shape = BoxShape{{1, 1, 1}};
    const auto prepared = prepare(scene);
    ASSERT_EQ(prepared.boxes.size(), 1U);
    EXPECT_EQ(prepared.boxes[0].lower, Vec3f(0, 0.5, 1));
}

TEST(Prepare, InstancesComeUnderTheirNode) {
    Scene scene = small_scene();
    scene.nodes[1].trs = {{0, 10, 0}, {}, {2, 2, 2}};
    scene.nodes[1].geometry[0].instances = {{{1, 0, 0}, {}, {1, 1, 1}}, {{0, 0, 1}, {}, {3, 3, 3}}};
    const auto prepared = prepare(scene);
    ASSERT_EQ(prepared.spheres.size(), 2U);
    EXPECT_EQ(prepared.spheres[0].centre, Vec3f(2, 10, 0));
    EXPECT_EQ(prepared.spheres[1].radius, 6);
    EXPECT_EQ(prepared.node_of, (std::vector<std::uint32_t>{1, 1}));
}

TEST(Prepare, IdsRunOverTheKindsInOrder) {
    Scene scene = small_scene();
    scene.materials.resize(4);
    scene.nodes[1].trs.scale = {1, 1, 2};
    scene.nodes[1].geometry = {{SphereShape{1}, 3, {}}, {BoxShape{}, 2, {}}};  // an ellipsoid and a box
    scene.nodes.push_back({});
    scene.nodes.back().geometry = {{SphereShape{1}, 1, {}}};
    const auto prepared = prepare(scene);
    EXPECT_EQ(prepared.material_of, (std::vector<std::uint32_t>{1, 2, 3}));
    EXPECT_EQ(prepared.node_of, (std::vector<std::uint32_t>{3, 1, 1}));
}

TEST(Prepare, FollowsTheAnimation) {
    Scene scene = small_scene();
    EXPECT_EQ(prepare(scene, {24, ""}).lights[0].position, Vec3f(2, 4, 6));
    EXPECT_EQ(prepare(scene, {36, ""}).lights[0].position, Vec3f(2.5F, 4, 5.5F));
    scene.nodes[2].light->colour = {1, 0.5F, 0.25F};
    scene.nodes[2].light->intensity = 4;
    EXPECT_EQ(prepare(scene).lights[0].intensity, Vec3f(4, 2, 1));
}

TEST(Prepare, FindsTheCameraByItsName) {
    Scene scene = small_scene();
    scene.nodes.resize(4);
    scene.nodes[3].name = "other";
    scene.nodes[3].camera = OrthographicCamera{2.5};
    scene.nodes[3].trs.translation = {0, 0, 8};
    EXPECT_FALSE(prepare(scene).orthographic);
    EXPECT_DOUBLE_EQ(prepare(scene).half_height, std::tan(0.5));
    const auto other = prepare(scene, {0, "other"});
    EXPECT_TRUE(other.orthographic);
    EXPECT_EQ(other.half_height, 2.5);
    EXPECT_EQ(other.world_from_camera.translation, Vec3d(0, 0, 8));
    EXPECT_TRUE(contains(input_error([&] {
                             (void)prepare(scene, {0, "third"});
                         }),
                         "no camera 'third'; it has 'eye', 'other'"));
    scene.nodes[0].camera.reset();
    scene.nodes[3].camera.reset();
    EXPECT_TRUE(contains(input_error([&] { (void)prepare(scene); }), "the scene has no camera"));
    EXPECT_TRUE(contains(input_error([&] { (void)prepare(scene, {0, "eye"}); }), "it has none"));
}

TEST(Prepare, ScaleDoesNotChangeWhatACameraSees) {
    Scene scene = small_scene();
    scene.nodes[0].trs.rotation = about_z(0.4);
    const auto plain = prepare(scene);
    scene.nodes[0].trs.scale = {2, 5, 0.5};
    const auto scaled = prepare(scene);
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(plain.world_from_camera.linear.row[i][k], scaled.world_from_camera.linear.row[i][k], 1e-15);
        }
    }
    scene.nodes[0].trs.scale = {1, 0, 1};
    EXPECT_TRUE(contains(input_error([&] { (void)prepare(scene); }), "node 0 'eye' has a camera under a transform"));
}

TEST(Prepare, TheSameSceneGivesTheSameBytes) {
    EXPECT_EQ(scene_hash(prepare(small_scene(), {7, ""})), scene_hash(prepare(small_scene(), {7, ""})));
}

}  // namespace
}  // namespace tandem
