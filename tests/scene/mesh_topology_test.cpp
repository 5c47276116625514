// Closed meshes, and what is culled of meshes.
#include "tandem/scene/mesh_topology.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/scene/icosphere.h"
#include "tandem/scene/named_scenes.h"

namespace tandem {
namespace {

Mesh ball() { return named_scene("icosphere/2").meshes.at(0); }

TEST(MeshTopology, AClosedMeshIsClosed) {
    EXPECT_TRUE(is_closed(ball()));
    EXPECT_FALSE(is_closed(Mesh{}));
}

TEST(MeshTopology, AMissingFaceOpensIt) {
    Mesh mesh = ball();
    mesh.triangles.resize(mesh.triangles.size() - 3);
    EXPECT_FALSE(is_closed(mesh));
}

TEST(MeshTopology, AFaceTurnedRoundOpensIt) {
    Mesh mesh = ball();
    std::swap(mesh.triangles[0], mesh.triangles[1]);
    EXPECT_FALSE(is_closed(mesh));
}

TEST(MeshTopology, FrontsThatLookInwardAreNotClosed) {
    Mesh mesh = ball();
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) std::swap(mesh.triangles[i], mesh.triangles[i + 1]);
    EXPECT_FALSE(is_closed(mesh));
}

// As exporters write them: every face with vertices of its own.
TEST(MeshTopology, VerticesOfOnePlaceAreOne) {
    const Mesh shared = ball();
    Mesh mesh;
    for (const std::uint32_t i : shared.triangles) {
        mesh.triangles.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.push_back(shared.positions[i]);
    }
    EXPECT_TRUE(is_closed(mesh));
}

TEST(MeshTopology, QuadsAndTrianglesCloseTogether) {
    Mesh prism{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}},
               .triangles = {0, 2, 1, 3, 4, 5},
               .quads = {0, 1, 4, 3, 1, 2, 5, 4, 2, 0, 3, 5}};
    EXPECT_TRUE(is_closed(prism));
    prism.quads.resize(8);
    EXPECT_FALSE(is_closed(prism));
}

/// A ball of radius 1 around the origin under a culled material, seen from `eye`.
Scene seen_from(const Vec3d& eye, const Camera& camera, bool closed) {
    Scene scene;
    scene.meshes = {ball()};
    scene.meshes[0].is_closed = closed;
    scene.materials = {{"skin", {}, FaceSides::culled}};
    Node body{.name = "ball"};
    body.geometry.push_back({MeshShape{0}, 0, {}});
    Node view{.name = "eye", .trs = {.translation = eye}, .camera = camera};
    scene.nodes = {body, view};
    return scene;
}

TEST(Culling, CostsNothingWhereNoBackCanBeSeen) {
    const auto culls = [](const Vec3d& eye, const Camera& camera, bool closed) {
        const PreparedScene prepared = prepare(seen_from(eye, camera, closed));
        const bool effect = prepared.effects.has(Effect::cutouts);
        EXPECT_EQ(effect, prepared.triangles[0].attributes.sides == FaceSides::culled);
        EXPECT_EQ(effect, prepared.cutout_kinds != 0);
        EXPECT_EQ(prepared.masked_kinds, 0U);
        return effect;
    };
    EXPECT_FALSE(culls({0, 0, 3}, PerspectiveCamera{}, true));
    EXPECT_TRUE(culls({0, 0, 3}, PerspectiveCamera{}, false)) << "an open mesh";
    EXPECT_TRUE(culls({0.1, 0, 0}, PerspectiveCamera{}, true)) << "the camera stands inside";
    EXPECT_FALSE(culls({0, 0, 1.3}, PerspectiveCamera{.lens = {0.1, 3}}, true));
    EXPECT_TRUE(culls({0, 0, 1.05}, PerspectiveCamera{.lens = {0.1, 3}}, true)) << "the lens reaches inside";
    EXPECT_FALSE(culls({5, 0, 3}, OrthographicCamera{1}, true));
    EXPECT_TRUE(culls({5, 0, 0.2}, OrthographicCamera{1}, true)) << "its plane crosses the ball";
}

TEST(Culling, StaysWhereAnAlphaMaskOpensAClosedMesh) {
    Scene scene = seen_from({0, 0, 3}, PerspectiveCamera{}, true);
    const auto sides = [&] { return prepare(scene).triangles[0].attributes.sides; };
    scene.materials[0].alpha_mode = AlphaMode::mask;
    EXPECT_EQ(sides(), FaceSides::single_sided) << "the mask is nowhere open";
    scene.meshes[0].colours.assign(scene.meshes[0].positions.size(), {{1, 1, 1}, 1});
    scene.meshes[0].colours[0].alpha = 0;
    EXPECT_EQ(sides(), FaceSides::culled);
}

TEST(Culling, IsForcedOffWithCutouts) {
    PrepareOptions options;
    options.effects.off = Effect::cutouts;
    const PreparedScene prepared = prepare(seen_from({0, 0, 3}, PerspectiveCamera{}, false), options);
    EXPECT_EQ(prepared.triangles[0].attributes.sides, FaceSides::single_sided);
}

}  // namespace
}  // namespace tandem
