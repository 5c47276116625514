// Skinned meshes: where their joints put them at rest.
#include <gtest/gtest.h>

#include "gltf/files.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem {
namespace {

using test::bytes_of;
using test::contains;
using test::Json;
using test::sentences;
using test::TestFile;

/// mesh_file() whose sheet follows two joints: "root" at (0, 10, 0), with a child "tip" another 5 above. The inverse
/// bind matrices take the joints' own places at binding away: none for the root, (0, 1, 0) for the tip. The node of the
/// sheet stands far away, which does not count.
TestFile skinned_file() {
    TestFile file = test::mesh_file();
    Json& nodes = file.json["nodes"];
    nodes[1]["skin"] = 0;
    nodes[1]["translation"] = {1000, 0, 0};
    nodes.push_back({{"name", "root"}, {"translation", {0, 10, 0}}, {"children", {3}}});
    nodes.push_back({{"name", "tip"}, {"translation", {0, 5, 0}}});
    file.json["scenes"][0]["nodes"].push_back(2);
    const std::vector<float> identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    std::vector<float> matrices = identity;
    matrices.insert(matrices.end(), identity.begin(), identity.end());
    matrices[16 + 13] = -1;
    file.json["skins"] = {{{"joints", {2, 3}}, {"inverseBindMatrices", file.add_floats("MAT4", matrices)}}};
    const std::vector<std::uint8_t> joints = {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
    const std::size_t accessor = file.add_bytes("VEC4", 5121, 6, bytes_of(joints));
    file.json["accessors"][accessor]["normalized"] = false;
    std::vector<float> weights(24, 0);
    for (std::size_t i = 0; i < 6; ++i) weights[4 * i + i % 2] = 1;  // root, tip, root, ...
    weights[0] = weights[1] = 2;                                     // the first one half of each, in proportion
    Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = accessor;
    attributes["WEIGHTS_0"] = file.add_floats("VEC4", weights);
    return file;
}

class Skins : public test::GltfFiles {
  protected:
    /// The posed mesh, which is the last one of the scene.
    static const Mesh& posed(const ImportResult& result) { return result.scene.meshes.back(); }
};

TEST_F(Skins, PoseTheirMeshAtRest) {
    const Mesh plain = import(test::mesh_file()).scene.meshes.at(0);
    const ImportResult result = import(skinned_file());
    ASSERT_EQ(result.scene.meshes.size(), 2U);
    const Mesh& mesh = posed(result);
    EXPECT_EQ(mesh.positions[0], plain.positions[0] + Vec3f(0, 12, 0)) << "between 10 and 10 + 5 - 1";
    EXPECT_EQ(mesh.positions[1], plain.positions[1] + Vec3f(0, 14, 0));
    EXPECT_EQ(mesh.positions[2], plain.positions[2] + Vec3f(0, 10, 0));
    EXPECT_EQ(mesh.triangles, plain.triangles);
    EXPECT_TRUE(contains(sentences(result.report), "approximated: skin at nodes[1].skin: posed by its joints at rest"));
}

TEST_F(Skins, DoNotFollowTheirNode) {
    const ImportResult result = import(skinned_file());
    EXPECT_TRUE(result.scene.nodes[1].geometry.empty());
    const Node& root = result.scene.nodes.back();
    EXPECT_EQ(root.name, "sheet");
    EXPECT_EQ(root.parent, Node::no_parent);
    ASSERT_EQ(root.geometry.size(), 1U);
    EXPECT_LT(prepare(result.scene).triangles[0].v0.x, 100) << "its node stands at 1000";
}

TEST_F(Skins, TurnNormalsByTheInverseTranspose) {
    TestFile file = skinned_file();
    file.json["nodes"][2]["scale"] = {2, 1, 1};
    std::vector<float> normals;
    for (int i = 0; i < 6; ++i) normals.insert(normals.end(), {0.6F, 0.8F, 0});
    file.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = file.add_floats("VEC3", normals);
    const Vec3f normal = posed(import(file)).normals[2];
    EXPECT_NEAR(normal.x / normal.y, 0.6 / 0.8 / 2, 1e-6);
    EXPECT_NEAR(dot(normal, normal), 1, 1e-6);
}

TEST_F(Skins, NeedNoInverseBindMatrices) {
    TestFile file = skinned_file();
    file.json["skins"][0].erase("inverseBindMatrices");
    const Mesh plain = import(test::mesh_file()).scene.meshes.at(0);
    EXPECT_EQ(posed(import(file)).positions[1], plain.positions[1] + Vec3f(0, 15, 0));
}

TEST_F(Skins, ThatCannotBeUsedLeaveTheMeshAtItsNode) {
    const auto expect_ignored = [&](const TestFile& file, const std::string& reason) {
        const ImportResult result = import(file);
        EXPECT_TRUE(contains(sentences(result.report), "ignored: skin at ")) << reason;
        EXPECT_TRUE(contains(sentences(result.report), reason));
        EXPECT_EQ(result.scene.nodes[1].geometry.size(), 1U);
    };
    TestFile file = skinned_file();
    file.json["skins"][0]["joints"] = {2};
    expect_ignored(file, "follows joint 1, but the skin has 1");
    file = skinned_file();
    file.json["skins"][0]["joints"] = {2, 3, 0};
    expect_ignored(file, "has 2 matrices for 3 joints");
    file = skinned_file();
    file.json["scenes"][0]["nodes"] = {0, 1};
    expect_ignored(file, "skins[0].joints[0]: is a node outside of the scene");
    file = skinned_file();
    file.json["accessors"][file.json["skins"][0]["inverseBindMatrices"].get<std::size_t>()]["type"] = "VEC4";
    expect_ignored(file, "needs MAT4");
}

TEST_F(Skins, CannotReadBeyondTheirBuffer) {
    TestFile file = skinned_file();
    file.json["accessors"][file.json["skins"][0]["inverseBindMatrices"].get<std::size_t>()]["count"] = 1000;
    const ImportResult result = import(file);
    EXPECT_TRUE(contains(sentences(result.report), "needs 64000 bytes for its 1000 elements"));
    EXPECT_EQ(result.scene.meshes.size(), 1U) << "nothing was posed";
}

}  // namespace
}  // namespace tandem
