#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "support/scenes.h"

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

TEST(Prepare, DropsAndCountsWhatATransformHides) {
    for (const Shape& shape : {Shape(SphereShape{1}), Shape(BoxShape{})}) {
        for (const Quaternion& turn : {Quaternion{}, about_z(0.3)}) {
            for (const Vec3d& scale : {Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{1e-60, 1e-60, 1e-60}}) {
                const auto prepared = prepare_body(shape, {{1, 2, 3}, turn, scale});
                EXPECT_EQ(prepared.dropped_primitives, 1U);
                EXPECT_TRUE(prepared.spheres.empty() && prepared.boxes.empty() && prepared.ellipsoids.empty() &&
                            prepared.parallelepipeds.empty());
            }
        }
    }
}

TEST(Prepare, DirectionsOfLightsAreUnitVectorsOfDoubles) {
    Scene scene = small_scene();
    for (const double scale : {1.0, 1e-200, 1e17}) {
        Node lamp{.name = "lamp", .trs = {{0, 3, 0}, {0.3, -0.2, 0.5, 0.7}, Vec3d{1, 1, 1} * scale}};
        lamp.light = LightSource{.kind = LightKind::directional};
        scene.nodes.push_back(lamp);
        const Vec3d direction = prepare(scene).lights.back().direction;
        EXPECT_NEAR(dot(direction, direction), 1, 1e-15) << scale;
        scene.nodes.pop_back();
    }
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

/// small_scene() with a mesh at "body".
Scene mesh_scene(Mesh mesh) {
    Scene scene = small_scene();
    mesh.name = "sheet";
    scene.meshes = {std::move(mesh)};
    scene.nodes[1].geometry[0].shape = MeshShape{0};
    return scene;
}

/// A square in the xy plane, front towards z, as two triangles.
Mesh square() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.triangles = {0, 1, 2, 0, 2, 3};
    return mesh;
}

TEST(PrepareMesh, PrimitivesKnowTheirOwner) {
    constexpr std::uint32_t faces = 64;  // as many as a mesh must have to be kept once, and eight instances
    Mesh mesh = square();
    while (mesh.triangles.size() < 3 * faces) mesh.triangles.insert(mesh.triangles.end(), {0, 1, 2, 0, 2, 3});
    Scene scene = mesh_scene(mesh);
    scene.materials.push_back(scene.materials[0]);
    scene.meshes.push_back(scene.meshes[0]);
    const auto second = static_cast<std::uint32_t>(scene.nodes.size()), again = second + 1;
    scene.nodes.resize(second + 2, scene.nodes[1]);
    for (const std::uint32_t node : {1U, second}) {
        for (int k = 0; k < 8; ++k) scene.nodes[node].geometry[0].instances.push_back({.translation = {1.0 * k, 0, 0}});
    }
    scene.nodes[second].name = "second";
    scene.nodes[second].geometry[0].shape = MeshShape{1};
    scene.nodes[second].geometry[0].material = 1;
    scene.nodes[again].name = "again";
    for (const std::uint64_t instanced_from : {1U, 100'000U}) {  // kept once, and written out
        const auto prepared = prepare_shared(scene, {.instanced_from = instanced_from});
        ASSERT_EQ(prepared->instances.empty(), instanced_from > 1);
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> counts;
        for (std::uint32_t id = 0; id < 17 * faces; ++id) {
            const PrimitiveOwner owner = owner_of(*prepared, id);
            ++counts[{owner.node, owner.material}];
        }
        const decltype(counts) right = {{{1, 0}, 8 * faces}, {{second, 1}, 8 * faces}, {{again, 0}, faces}};
        EXPECT_EQ(counts, right) << instanced_from;
        EXPECT_EQ(input_error([&] { static_cast<void>(owner_of(*prepared, 17 * faces)); }),
                  "there is no primitive 1088: the prepared scene has 1088");
        EXPECT_THROW(static_cast<void>(owner_of(*prepared, no_primitive)), InputError);
    }
}

TEST(PrepareMesh, SharedVerticesHaveTheSameBits) {
    Scene scene = mesh_scene(square());
    scene.nodes[1].trs = {{0.1, 1e3, 7}, {0.1, 0.2, 0.3, 0.9}, {3, 0.7, 1}};
    const auto prepared = prepare(scene, {.origin = Vec3d{0, 0, 0}});
    ASSERT_EQ(prepared.triangles.size(), 2U);
    const Transform world = to_transform(scene.nodes[1].trs);
    EXPECT_EQ(prepared.triangles[0].v1, narrow(transform_point(world, {1, 0, 0})));
    EXPECT_EQ(prepared.triangles[0].v0, prepared.triangles[1].v0);
    EXPECT_EQ(prepared.triangles[0].v2, prepared.triangles[1].v1);
    EXPECT_TRUE(prepared.normals.empty());
    EXPECT_EQ(prepared.triangles[0].attributes.normals, no_attributes);
}

TEST(PrepareMesh, AMirrorTurnsTheCornersRound) {
    Mesh mesh = square();
    mesh.quads = {0, 1, 2, 3};
    mesh.normals.assign(4, {0, 0, 1});
    for (const double sign : {1.0, -1.0}) {
        Scene scene = mesh_scene(mesh);
        scene.nodes[1].trs.scale = {sign, 2, 0.5};
        const auto prepared = prepare(scene);
        for (const Triangle& t : prepared.triangles) EXPECT_EQ(triangle_normal(t.v0, t.v1, t.v2), Vec3d(0, 0, 1));
        const Quad& q = prepared.quads[0];
        EXPECT_EQ(triangle_normal(q.v0, q.v1, q.v2), Vec3d(0, 0, 1));
        EXPECT_EQ(q.v2, Vec3f(static_cast<float>(sign), 2, 0)) << "the diagonal stays";
        for (const Vec3f& n : prepared.normals) EXPECT_EQ(n, Vec3f(0, 0, 1));
    }
}

TEST(PrepareMesh, NormalsGoByTheInverseTranspose) {
    Mesh mesh = square();
    mesh.normals.assign(4, narrow(normalize(Vec3d{1, 0, 1})));
    Scene scene = mesh_scene(mesh);
    scene.nodes[1].trs.scale = {2, 1, 1};  // the surface gets flatter, the normal steeper
    EXPECT_NEAR(prepare(scene).normals[0].x, std::sqrt(0.2), 1e-7);
    EXPECT_NEAR(prepare(scene).normals[0].z, std::sqrt(0.8), 1e-7);
    scene.nodes[1].trs.scale = {1, 1, 0};  // flattened onto the plane: its normal is what is left
    EXPECT_EQ(prepare(scene).normals[0], Vec3f(0, 0, 1));
    scene.nodes[1].trs.scale = {-1e-120, 1e-120, 1e-120};
    scene.nodes[1].trs.scale = scene.nodes[1].trs.scale * 1e100;
    EXPECT_NEAR(prepare(scene).normals[0].x, -std::sqrt(0.5), 1e-7);
}

TEST(PrepareMesh, AttributesStandByCorner) {
    Mesh mesh = square();
    mesh.quads = {3, 2, 1, 0};
    mesh.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}};
    mesh.texcoords = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    Scene scene = mesh_scene(mesh);
    EXPECT_TRUE(prepare(scene).texcoords.empty()) << "no texture uses them";
    scene.images = {{"picture", 2, 1, {0xFF000000U, 0xFFFFFFFFU}}};
    scene.textures = {Texture{}};
    scene.materials[0].diffuse_texture = TextureReference{};
    const auto prepared = prepare(scene);
    ASSERT_EQ(prepared.normals.size(), 10U);
    ASSERT_EQ(prepared.texcoords.size(), 10U);
    EXPECT_EQ(prepared.triangles[1].attributes.normals, 3U);
    EXPECT_EQ(prepared.normals[5], mesh.normals[3]);
    EXPECT_EQ(prepared.quads[0].attributes.texcoords, 6U);
    EXPECT_EQ(prepared.texcoords[7], mesh.texcoords[0][2]);
}

TEST(PrepareMesh, FacesWithoutAreaAreDroppedAndCounted) {
    Mesh mesh = square();
    mesh.positions.push_back({0.5F, 0.5F, 0});
    mesh.triangles = {0, 1, 2, 0, 0, 1, 0, 4, 2, 3, 3, 3};
    mesh.quads = {0, 1, 2, 3,   // good
                  0, 1, 1, 3,   // its first half is flat: the triangle (0, 1, 3)
                  0, 1, 2, 2,   // its second half is: (0, 1, 2)
                  0, 4, 2, 4,   // both are
                  0, 1, 0, 1};  // both are
    Scene scene = mesh_scene(mesh);
    const auto prepared = prepare(scene);
    EXPECT_EQ(prepared.triangles.size(), 3U);
    EXPECT_EQ(prepared.quads.size(), 1U);
    EXPECT_EQ(prepared.dropped_primitives, 5U);
    EXPECT_EQ(prepared.material_of.size(), 4U);
    EXPECT_EQ(prepared.triangles[1].v2, Vec3f(0, 1, 0));
    EXPECT_EQ(prepared.triangles[2].v2, Vec3f(1, 1, 0));
    scene.nodes[1].trs.scale = {1, 0, 1};  // everything becomes a line
    EXPECT_EQ(prepare(scene).dropped_primitives, 9U);
    EXPECT_EQ(primitive_count(prepare(scene)), 0U);
}

TEST(PrepareMesh, InstancesAndSides) {
    Scene scene = mesh_scene(square());
    scene.materials[0].sides = FaceSides::double_sided;
    scene.nodes[1].geometry[0].instances = {{{1, 0, 0}, {}, {1, 1, 1}}, {{0, 0, 5}, {}, {2, 2, 2}}};
    const auto prepared = prepare(scene);
    ASSERT_EQ(prepared.triangles.size(), 4U);
    EXPECT_EQ(prepared.triangles[3].v2, Vec3f(0, 2, 5));
    EXPECT_EQ(prepared.triangles[3].attributes.sides, FaceSides::double_sided);
    EXPECT_EQ(prepared.node_of, (std::vector<std::uint32_t>{1, 1, 1, 1}));
    scene.nodes[1].trs.scale = {9e17, 9e17, 9e17};
    EXPECT_TRUE(
        contains(input_error([&] { (void)prepare(scene); }), "node 1 'body' has coordinates farther than 1e18"));
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
    EXPECT_FALSE(prepare(scene).camera.orthographic);
    EXPECT_DOUBLE_EQ(prepare(scene).camera.half_height, std::tan(0.5));
    const auto other = prepare(scene, {0, "other"});
    EXPECT_TRUE(other.camera.orthographic);
    EXPECT_EQ(other.camera.half_height, 2.5);
    EXPECT_EQ(other.camera.render_from_camera.translation, Vec3d(0, 0, 8));
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
            EXPECT_NEAR(plain.camera.render_from_camera.linear.row[i][k],
                        scaled.camera.render_from_camera.linear.row[i][k], 1e-15);
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
