// Meshes with numbers and indices that stand for nothing: the rest is drawn.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gltf/files.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem {
namespace {

using test::contains;
using test::Json;
using test::mesh_file;
using test::sentences;
using test::TestFile;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

class MendedMesh : public test::GltfFiles {
  protected:
    static Json& primitive(TestFile& file) { return file.json["meshes"][0]["primitives"][0]; }
    static TestFile with_indices(int component_type, const std::vector<std::uint32_t>& indices, int mode = 4) {
        TestFile file = mesh_file();
        primitive(file)["indices"] = file.add_indices(component_type, indices);
        primitive(file)["mode"] = mode;
        return file;
    }
    /// The mesh, of a file whose report has the sentence.
    Mesh mesh_of(const TestFile& file, const std::string& sentence) const {
        const ImportResult result = import(file);
        EXPECT_TRUE(contains(sentences(result.report), sentence));
        return result.scene.meshes.at(0);
    }
    using Indices = std::vector<std::uint32_t>;
};

/// glTF 2.0, 3.7.2.1: the largest value of a type is no index, since GPUs begin anew there.
TEST_F(MendedMesh, BeginsAnewAtTheLargestIndex) {
    for (const auto& [type, largest] : {std::pair{5121, 255U}, {5123, 65535U}, {5125, 0xFFFFFFFFU}}) {
        const std::string sentence = "primitive restart at meshes[0].primitives[0].indices: entry 3 is " +
                                     std::to_string(largest) + ", which glTF forbids; as on GPUs, the ";
        const Indices strip = {0, 1, 2, largest, 2, 3, 4, 5};
        EXPECT_EQ(mesh_of(with_indices(type, strip, 5), sentence + "triangle strip restarts after it").triangles,
                  (Indices{0, 1, 2, 2, 3, 4, 3, 5, 4}));
        EXPECT_EQ(mesh_of(with_indices(type, strip, 6), sentence + "triangle fan restarts after it").triangles,
                  (Indices{1, 2, 0, 3, 4, 2, 4, 5, 2}));
        EXPECT_EQ(mesh_of(with_indices(type, {0, 1, 2, largest, 3, largest, 3, 4, 5, 1}), sentence).triangles,
                  (Indices{0, 1, 2, 3, 4, 5}));
        EXPECT_TRUE(
            contains(error_of(with_indices(type, {largest, 1, 2, largest, largest})), "and no triangle is left"));
    }
}

/// A vertex of that number is none either.
TEST_F(MendedMesh, BeginsAnewWhereThereAre256Vertices) {
    TestFile file = mesh_file();
    std::vector<float> positions(std::size_t{300} * 3);
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = static_cast<float>(i % 7);
    primitive(file)["attributes"]["POSITION"] = file.add_floats("VEC3", positions);
    primitive(file)["indices"] = file.add_indices(5121, {0, 1, 2, 253, 254, 255});
    EXPECT_EQ(mesh_of(file, "entry 5 is 255").triangles, (Indices{0, 1, 2}));
    primitive(file)["indices"] = file.add_indices(5123, {0, 1, 2, 253, 254, 255});
    EXPECT_EQ(mesh_of(file, "").triangles, (Indices{0, 1, 2, 3, 4, 5})) << "of the vertices that are used";
}

TEST_F(MendedMesh, LeavesOutCornersOfNoTriangle) {
    EXPECT_EQ(
        mesh_of(with_indices(5121, {0, 1, 2, 3}),
                "approximated: corners at meshes[0].primitives[0]: has 4 corners; a triangle mesh needs a multiple of "
                "3, so Tandem leaves out the last")
            .triangles,
        (Indices{0, 1, 2}));
}

TEST_F(MendedMesh, LeavesOutTrianglesWithoutAVertex) {
    EXPECT_EQ(mesh_of(with_indices(5125, {0, 1, 6, 2, 1, 3, 0, 4294967294U, 1}),
                      "approximated: triangles at meshes[0].primitives[0].indices: name vertex 6, but POSITION has 6 "
                      "vertices; Tandem leaves out 2 of 3 triangles")
                  .triangles,
              (Indices{1, 0, 2}));
    EXPECT_TRUE(
        contains(error_of(with_indices(5125, {0, 1, 6})), "indices: name vertex 6, but POSITION has 6 vertices"));
}

TEST_F(MendedMesh, LeavesOutTrianglesWithoutAPlace) {
    for (const float bad : {nan, std::numeric_limits<float>::infinity(), 1e19F}) {
        TestFile file = mesh_file();
        primitive(file)["attributes"]["POSITION"] =
            file.add_floats("VEC3", {bad, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0});
        const Mesh mesh = mesh_of(file,
                                  "triangles at meshes[0].primitives[0].attributes.POSITION: element 0 has a number "
                                  "that is not finite or beyond 1e18; Tandem leaves out 1 of 2 triangles");
        EXPECT_EQ(mesh.triangles, (Indices{2, 1, 3}));
        EXPECT_EQ(mesh.positions[0], Vec3f(0, 0, 0));
        EXPECT_EQ(prepare(import(file).scene).triangles.size(), 1U);
    }
}

/// The first two vertices have their triangle's normal alone; the next two share both triangles, which lie in one
/// plane.
TEST_F(MendedMesh, TakesTheNormalsOfTheTriangles) {
    TestFile file = mesh_file();
    std::vector<float> normals(18, 0.5F);
    normals[1] = normals[7] = nan;
    normals[15] = 1e30F;  // of a vertex that no triangle has
    primitive(file)["attributes"]["NORMAL"] = file.add_floats("VEC3", normals);
    const Mesh mesh =
        mesh_of(file,
                "approximated: normals at meshes[0].primitives[0].attributes.NORMAL: element 0 has a "
                "number that is not finite or beyond 1e18; Tandem uses the mean normal of the adjacent triangles");
    EXPECT_EQ(mesh.normals[0], Vec3f(0, 0, 1));
    EXPECT_EQ(mesh.normals[1], Vec3f(0.5F, 0.5F, 0.5F));
    EXPECT_EQ(mesh.normals[2], Vec3f(0, 0, 1));
    EXPECT_EQ(mesh.normals[5], Vec3f(0, 0, 0));
}

TEST_F(MendedMesh, TakesTheCornerForTextureCoordinatesThatAreNoNumbers) {
    TestFile file = test::pictured_mesh_file();
    file.json["materials"][0]["normalTexture"] = {{"index", 0}};
    primitive(file)["attributes"]["TEXCOORD_0"] =
        file.add_floats("VEC2", {0, 0, 0.5F, nan, 1, 1, 0.25F, 0.5F, 0, 0, 0, 0});
    const Mesh mesh =
        mesh_of(file, "texture coordinates at meshes[0].primitives[0].attributes.TEXCOORD_0: element 1 has");
    EXPECT_EQ(mesh.texcoords.at(0)[1], Vec2f(0, 0));
    EXPECT_EQ(mesh.texcoords.at(0)[3], Vec2f(0.25F, 0.5F));
}

TEST_F(MendedMesh, GoesWithoutAttributesThatDoNotFit) {
    TestFile file = test::pictured_mesh_file();
    file.json["materials"][0]["normalTexture"] = {{"index", 0}};
    primitive(file)["attributes"]["NORMAL"] = file.add_floats("VEC3", {0, 0, 1});
    primitive(file)["attributes"]["TEXCOORD_0"] = file.add_floats("VEC3", std::vector<float>(18, 1));
    const Mesh mesh = mesh_of(file,
                              "ignored: attribute NORMAL at meshes[0].primitives[0].attributes.NORMAL: has 1 elements, "
                              "but POSITION has 6; make them equal");
    EXPECT_TRUE(mesh.normals.empty());
    const Mesh other = mesh_of(file, "ignored: attribute TEXCOORD_0 at accessors[3]: is of type VEC3, but");
    EXPECT_EQ(other.texcoords.at(0), std::vector<Vec2f>(6, Vec2f(0, 0)))
        << "the texture's corner texel covers the mesh";
}

/// What is left out is not called rendered.
TEST_F(MendedMesh, LeavesOutAPrimitiveAndDrawsTheOthers) {
    TestFile file = mesh_file();
    Json bad = primitive(file);
    bad["indices"] = file.add_indices(5125, {7, 8, 9});
    file.json["meshes"][0]["primitives"].push_back(bad);
    file.json["nodes"].push_back({{"mesh", 0}});
    file.json["scenes"][0]["nodes"].push_back(2);
    const ImportResult result = import(file);
    EXPECT_EQ(result.scene.nodes[1].geometry.size(), 1U);
    EXPECT_EQ(result.scene.nodes[2].geometry.size(), 1U);
    const std::string all = sentences(result.report);
    EXPECT_TRUE(contains(all, "rendered: triangle mesh at meshes[0].primitives[0] (2 uses)"));
    EXPECT_TRUE(contains(all, "ignored: primitive at meshes[0].primitives[1].indices: name vertex 7, but"));
}

}  // namespace
}  // namespace tandem
