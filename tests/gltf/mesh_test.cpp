// Triangle meshes in glTF: modes, indices, attributes, and what is wrong with them.
#include <gtest/gtest.h>

#include <functional>

#include "gltf/files.h"
#include "support/thrown_message.h"
#include "tandem/base/error.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem {
namespace {

using test::bytes_of;
using test::contains;
using test::Json;
using test::mesh_file;
using test::sentences;
using test::TestFile;

class GltfMesh : public test::GltfFiles {
  protected:
    static Json& primitive(TestFile& file) { return file.json["meshes"][0]["primitives"][0]; }
    Mesh mesh_of(const TestFile& file) const {
        const Scene scene = import(file).scene;
        EXPECT_EQ(scene.meshes.size(), 1U);
        return scene.meshes.at(0);
    }
    static std::vector<std::uint32_t> indices(std::initializer_list<std::uint32_t> values) { return values; }
};

TEST_F(GltfMesh, TrianglesWithIndicesOfEveryWidth) {
    for (const int component_type : {5121, 5123, 5125}) {
        TestFile file = mesh_file();
        primitive(file)["indices"] = file.add_indices(component_type, {0, 1, 2, 2, 1, 3});
        const Mesh mesh = mesh_of(file);
        EXPECT_EQ(mesh.triangles, indices({0, 1, 2, 2, 1, 3})) << component_type;
        EXPECT_EQ(mesh.positions.size(), 6U);
        EXPECT_EQ(mesh.positions[3], Vec3f(1, 1, 0));
    }
}

TEST_F(GltfMesh, TrianglesWithoutIndices) {
    TestFile file = mesh_file();
    primitive(file).erase("indices");
    EXPECT_EQ(mesh_of(file).triangles, indices({0, 1, 2, 3, 4, 5}));
}

TEST_F(GltfMesh, StripsAndFansRunAsGltfSays) {
    TestFile file = mesh_file();
    primitive(file)["indices"] = file.add_indices(5123, {0, 1, 2, 3, 4});
    primitive(file)["mode"] = 5;
    EXPECT_EQ(mesh_of(file).triangles, indices({0, 1, 2, 1, 3, 2, 2, 3, 4}));
    primitive(file)["mode"] = 6;
    EXPECT_EQ(mesh_of(file).triangles, indices({1, 2, 0, 2, 3, 0, 3, 4, 0}));
}

TEST_F(GltfMesh, NormalsAndTextureCoordinates) {
    TestFile file = test::pictured_mesh_file();
    primitive(file)["attributes"]["NORMAL"] = file.add_floats("VEC3", std::vector<float>(18, 0.5F));
    const std::size_t places =
        file.add_bytes("VEC2", 5121, 6, bytes_of(std::vector<std::uint8_t>{0, 255, 51, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
    primitive(file)["attributes"]["TEXCOORD_0"] = places;
    EXPECT_TRUE(mesh_of(file).texcoords.empty()) << "no texture uses them";
    file.json["materials"][0]["normalTexture"] = {{"index", 0}};
    const Mesh mesh = mesh_of(file);
    EXPECT_EQ(mesh.normals, std::vector<Vec3f>(6, Vec3f(0.5F, 0.5F, 0.5F)));
    EXPECT_EQ(mesh.texcoords.at(0)[0], Vec2f(0, 1));
    EXPECT_EQ(mesh.texcoords.at(0)[1], Vec2f(0.2F, 0));
    EXPECT_TRUE(mesh_of(mesh_file()).normals.empty());
}

TEST_F(GltfMesh, IntegersStandForPositions) {
    TestFile file = mesh_file();
    const std::size_t whole = file.add_bytes(
        "VEC3", 5122, 6, bytes_of(std::vector<std::int16_t>{0, 0, 0, 7, 0, 0, 0, -300, 0, 1, 1, 1, 2, 2, 2, 3, 3, 4}));
    file.json["accessors"][whole]["normalized"] = false;
    primitive(file)["attributes"]["POSITION"] = whole;
    EXPECT_EQ(mesh_of(file).positions[2], Vec3f(0, -300, 0));
    EXPECT_TRUE(
        contains(sentences(import(file).report),
                 "rendered: attribute POSITION at meshes[0].primitives[0].attributes.POSITION: has integers, which "
                 "only files that use KHR_mesh_quantization may have"));
    file.json["extensionsUsed"] = {"KHR_mesh_quantization"};
    file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    EXPECT_EQ(mesh_of(file).positions[2], Vec3f(0, -300, 0));
    EXPECT_EQ(sentences(import(file).report).find("has integers"), std::string::npos);
    EXPECT_TRUE(contains(sentences(import(file).report), "rendered: KHR_mesh_quantization at extensionsUsed[0]: "));
    file.json["accessors"][whole]["normalized"] = true;
    EXPECT_EQ(mesh_of(file).positions[1], Vec3f(7.0F / 32767, 0, 0));
}

/// 10^5 times a mesh of 20,000 faces.
TEST_F(GltfMesh, IsKeptOnceWhereItAppearsVeryOften) {
    TestFile file = mesh_file();
    constexpr std::uint32_t side = 100;
    std::vector<float> corners;
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i <= side; ++i) {
        for (std::uint32_t k = 0; k <= side; ++k) {
            corners.insert(corners.end(),
                           {static_cast<float>(i), static_cast<float>(i * k % 7), static_cast<float>(k)});
            const std::uint32_t first = i * (side + 1) + k;
            if (i == side || k == side) continue;
            indices.insert(indices.end(),
                           {first, first + 1, first + side + 2, first, first + side + 2, first + side + 1});
        }
    }
    primitive(file)["attributes"] = {{"POSITION", file.add_floats("VEC3", corners)}};
    primitive(file)["indices"] = file.add_indices(5125, indices);
    std::vector<float> places;
    for (int i = 0; i < 100'000; ++i) {
        places.insert(places.end(), {static_cast<float>(i % 300) * 120, 0, static_cast<float>(i / 300) * -120});
    }
    file.json["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", file.add_floats("VEC3", places)}};
    const PreparedScene prepared = prepare(import(file).scene);
    EXPECT_EQ(prepared.instances.instances.size(), 100'000U);
    EXPECT_EQ(prepared.instances.faces.size(), 20'000U);
    EXPECT_EQ(instanced_face_count(prepared.instances), 2'000'000'000U);
    EXPECT_EQ(primitive_count(prepared), 0U);
    const auto write_out = [&] { (void)written_out(prepared, only_cuda_keeps_instances); };
    const std::string refusal = test::thrown_message<EnvironmentError>(write_out);
    EXPECT_TRUE(contains(refusal, "the scene of 2000000000 faces, which are written out because only the backend cuda"))
        << refusal;
    file.json["materials"][0]["alphaMode"] = "MASK";
    EXPECT_EQ(prepare(import(file).scene).instances.instances.size(), 100'000U);
    file.json["materials"][0]["emissiveFactor"] = {1, 1, 1};
    EXPECT_TRUE(contains(error_of(file), "nodes: 1 of them show the equivalent of 2000000000 faces"));
}

TEST_F(GltfMesh, IsReadOnceHoweverManyNodesShowIt) {
    TestFile file = mesh_file();
    file.json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 1}}, {"scale", {-1, 1, 1}}});
    file.json["scenes"][0]["nodes"].push_back(2);
    file.json["materials"][0]["doubleSided"] = true;
    const auto result = import(file);
    ASSERT_EQ(result.scene.meshes.size(), 1U);
    EXPECT_EQ(result.scene.meshes[0].name, "sheet");
    EXPECT_EQ(std::get<MeshShape>(result.scene.nodes[2].geometry[0].shape).mesh, 0U);
    const PreparedScene prepared = prepare(result.scene);
    ASSERT_EQ(prepared.triangles.size(), 4U);
    EXPECT_EQ(prepared.triangles[2].v0, Vec3f(0, 0, 1));
    EXPECT_EQ(prepared.triangles[0].attributes.sides, FaceSides::double_sided);
    const std::string report = sentences(result.report);
    EXPECT_TRUE(contains(report, "rendered: triangle mesh at meshes[0].primitives[0] (2 uses): "));
    EXPECT_TRUE(contains(report, "rendered: doubleSided at materials[0].doubleSided: "));
}

/// As exporters write a mesh of many materials.
TEST_F(GltfMesh, OfSharedVerticesHasThoseThatItUses) {
    TestFile file = test::pictured_mesh_file();
    file.json["materials"][0]["normalTexture"] = {{"index", 0}};
    primitive(file)["attributes"]["TEXCOORD_0"] = file.add_floats("VEC2", {0, 0, 1, 0, 2, 0, 3, 0, 4, 0, 5, 0});
    primitive(file)["indices"] = file.add_indices(5121, {5, 1, 3});
    for (const bool is_sparse : {false, true}) {
        if (is_sparse) {
            const std::size_t which = file.add_bytes("SCALAR", 5121, 1, std::string(1, '\5'));
            const std::size_t what = file.add_floats("VEC3", {7, 8, 9});
            Json& accessors = file.json["accessors"];
            accessors[0]["sparse"] = {
                {"count", 1},
                {"indices", {{"bufferView", accessors[which]["bufferView"]}, {"componentType", 5121}}},
                {"values", {{"bufferView", accessors[what]["bufferView"]}}}};
        }
        const Mesh mesh = mesh_of(file);
        EXPECT_EQ(mesh.triangles, indices({2, 0, 1}));
        EXPECT_EQ(mesh.positions,
                  (std::vector<Vec3f>{{1, 0, 0}, {1, 1, 0}, is_sparse ? Vec3f{7, 8, 9} : Vec3f{1, 2, 0}}));
        EXPECT_EQ(mesh.texcoords.at(0), (std::vector<Vec2f>{{1, 0}, {3, 0}, {5, 0}}));
    }
}

TEST_F(GltfMesh, InstancesRepeatIt) {
    TestFile file = mesh_file();
    const std::size_t places = file.add_floats("VEC3", {0, 0, 1, 0, 0, 2, 0, 0, 3});
    file.json["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
    EXPECT_EQ(prepare(import(file).scene).triangles.size(), 6U);
}

TEST_F(GltfMesh, ReportsWhatItLeavesOut) {
    TestFile file = mesh_file();
    const Json positions = primitive(file)["attributes"]["POSITION"];
    for (const char* name : {"COLOR_1", "TANGENT", "JOINTS_0", "WEIGHTS_0", "TEXCOORD_1"}) {
        primitive(file)["attributes"][name] = positions;
    }
    Json lines = primitive(file);
    lines["mode"] = 3;
    Json nothing = primitive(file);
    nothing["attributes"] = {{"NORMAL", positions}};
    file.json["meshes"][0]["primitives"].push_back(lines);
    file.json["meshes"][0]["primitives"].push_back(nothing);
    const auto result = import(file);
    EXPECT_EQ(result.scene.nodes[1].geometry.size(), 1U);
    const std::string report = sentences(result.report);
    for (const char* sentence :
         {"rendered: triangle mesh at meshes[0].primitives[0]: ", "ignored: line strip at meshes[0].primitives[1]: ",
          "ignored: triangle mesh at meshes[0].primitives[2]: it has no positions",
          "ignored: attribute COLOR_1 at meshes[0].primitives[0].attributes.COLOR_1: ",
          "ignored: attribute TANGENT at meshes[0].primitives[0].attributes.TANGENT: ",
          "ignored: attribute JOINTS_0 at meshes[0].primitives[0].attributes.JOINTS_0: no node with a skin",
          "ignored: attribute WEIGHTS_0 at ", "ignored: attribute TEXCOORD_1 at "}) {
        EXPECT_TRUE(contains(report, sentence));
    }
}

TEST_F(GltfMesh, OfAnAnisotropicMaterialHasATangentWhereItHasCoordinates) {
    TestFile file = mesh_file();
    primitive(file)["material"] = 0;
    file.json["materials"] =
        Json::parse(R"([{"extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 1}}}])");
    const std::string note = "approximated: anisotropy without coordinates at meshes[0].primitives[0].attributes: ";
    EXPECT_TRUE(contains(sentences(import(file).report), note + "there is no TEXCOORD_0"));
    const std::size_t vertices = import(file).scene.meshes[0].positions.size();
    primitive(file)["attributes"]["TEXCOORD_0"] = file.add_floats("VEC2", std::vector<float>(2 * vertices, 0.5F));
    const ImportResult result = import(file);
    EXPECT_EQ(sentences(result.report).find(note), std::string::npos);
    EXPECT_EQ(result.scene.meshes[0].texcoords[0], std::vector<Vec2f>(vertices, Vec2f{0.5F, 0.5F}));
}

struct MeshFlaw {
    const char* name;
    std::function<void(TestFile&, Json& primitive)> make;
    const char* sentence;  ///< a part of it
};

void PrintTo(const MeshFlaw& flaw, std::ostream* out) { *out << flaw.name; }

class MalformedMesh : public GltfMesh, public testing::WithParamInterface<MeshFlaw> {};

TEST_P(MalformedMesh, IsNamedInOneSentence) {
    TestFile file = mesh_file();
    GetParam().make(file, primitive(file));
    EXPECT_TRUE(contains(error_of(file), GetParam().sentence));
}

INSTANTIATE_TEST_SUITE_P(
    Flaws, MalformedMesh,
    testing::Values(
        MeshFlaw{"short_strip",
                 [](TestFile& f, Json& p) {
                     p["indices"] = f.add_indices(5121, {0, 1});
                     p["mode"] = 5;
                 },
                 "has 2 corners; a triangle strip needs 3 or more"},
        MeshFlaw{"float_indices",
                 [](TestFile& f, Json& p) {
                     p["indices"] = f.add_floats("SCALAR", {0, 1, 2});
                 },
                 "but the indices of a mesh (meshes[0].primitives[0].indices) needs unsigned integers"},
        MeshFlaw{"signed_indices",
                 [](TestFile& f, Json& p) {
                     p["indices"] = f.add_indices(5121, {0, 1, 2});
                     f.json["accessors"].back()["componentType"] = 5120;
                 },
                 "has components of type 5120, but the indices"},
        MeshFlaw{"vector_indices",
                 [](TestFile& f, Json& p) {
                     p["indices"] = f.add_floats("VEC3", {0, 1, 2});
                 },
                 "is of type VEC3, but the indices of a mesh"},
        MeshFlaw{"flat_positions",
                 [](TestFile& f, Json& p) {
                     p["attributes"]["POSITION"] = f.add_floats("VEC2", {0, 1, 2, 3, 4, 5});
                 },
                 "is of type VEC2, but the attribute POSITION"},
        MeshFlaw{"no_accessor", [](TestFile&, Json& p) { p["attributes"]["POSITION"] = 77; },
                 "meshes[0].primitives[0].attributes.POSITION: is 77"},
        MeshFlaw{
            "nan",
            [](TestFile& f, Json& p) {
                std::vector<float> values(9, 0);
                values[4] = std::nanf("");
                p["attributes"]["POSITION"] = f.add_floats("VEC3", values);
            },
            "meshes[0].primitives[0].attributes.POSITION: element 1 has a number that is not finite or beyond 1e18"},
        MeshFlaw{"too_far",
                 [](TestFile& f, Json& p) {
                     p.erase("indices");
                     p["attributes"]["POSITION"] = f.add_floats("VEC3", std::vector<float>(9, 1e30F));
                 },
                 "POSITION: element 0 has a number that is not finite or beyond 1e18"},
        MeshFlaw{
            "repeated",
            [](TestFile& f, Json& p) {
                const std::size_t places = f.add_floats("VEC3", std::vector<float>(3 * 60'000, 1));
                p["indices"] = f.add_indices(5121, std::vector<std::uint32_t>(3 * 1000, 1));
                f.json["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
                f.json["materials"][0]["emissiveFactor"] = {1, 1, 1};  // else the mesh is kept once
            },
            "nodes: 1 of them show the equivalent of 60000000 faces, which takes 14.10 GB of memory; a file with"}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace tandem
