// What meshes look like beside their shape: colours of vertices, several sets of texture coordinates, emissive
// textures, unlit materials, backs of faces.
#include <gtest/gtest.h>

#include "gltf/files.h"
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

class Appearance : public test::GltfFiles {
  protected:
    static Json& attributes(TestFile& file) { return file.json["meshes"][0]["primitives"][0]["attributes"]; }
    static Json& material(TestFile& file) { return file.json["materials"][0]; }
};

TEST_F(Appearance, VertexColoursOfEveryType) {
    TestFile file = mesh_file();
    attributes(file)["COLOR_0"] = file.add_floats("VEC3", std::vector<float>(18, 0.25F));
    EXPECT_EQ(import(file).scene.meshes[0].colours.at(5).rgb, Vec3f(0.25F, 0.25F, 0.25F));
    EXPECT_EQ(import(file).scene.meshes[0].colours.at(5).alpha, 1);
    attributes(file)["COLOR_0"] =
        file.add_bytes("VEC4", 5121, 6, bytes_of(std::vector<std::uint8_t>(24, std::uint8_t{51})));
    const ImportResult result = import(file);
    EXPECT_EQ(result.scene.meshes[0].colours.at(0).rgb, Vec3f(0.2F, 0.2F, 0.2F));
    EXPECT_EQ(result.scene.meshes[0].colours.at(0).alpha, 0.2F);
    EXPECT_TRUE(contains(sentences(result.report),
                         "rendered: vertex colours at meshes[0].primitives[0].attributes.COLOR_0: linear"));
    const PreparedScene prepared = prepare(result.scene);
    ASSERT_EQ(prepared.texcoords.size(), 2 * 3 * prepared.triangles.size());
    EXPECT_EQ(prepared.textures.materials.at(prepared.material_of[0]).colour_slot, 0U);
    EXPECT_EQ(prepared.texcoords[0], Vec2f(0.2F, 0.2F));
}

TEST_F(Appearance, VertexColoursThatAreWhiteCostNothing) {
    TestFile file = mesh_file();
    attributes(file)["COLOR_0"] = file.add_floats("VEC3", std::vector<float>(18, 1));
    EXPECT_TRUE(import(file).scene.meshes[0].colours.empty());
    EXPECT_TRUE(prepare(import(file).scene).texcoords.empty());
}

TEST_F(Appearance, VertexColoursOutOfRangeOrOfAWrongTypeAreNoted) {
    TestFile file = mesh_file();
    attributes(file)["COLOR_0"] = file.add_floats("VEC3", std::vector<float>(18, 3));
    EXPECT_TRUE(contains(sentences(import(file).report), "approximated: vertex colours at "));
    attributes(file)["COLOR_0"] = file.add_floats("SCALAR", std::vector<float>(6, 0.5F));
    EXPECT_TRUE(contains(sentences(import(file).report), "ignored: vertex colours at "));
    attributes(file)["COLOR_0"] = file.add_floats("VEC3", std::vector<float>(9, 0.5F));
    EXPECT_TRUE(contains(sentences(import(file).report), "there is not one per position"));
}

TEST_F(Appearance, EachTextureLiesAtItsOwnCoordinates) {
    TestFile file = test::pictured_mesh_file();
    material(file)["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}, {"texCoord", 3}};
    material(file)["normalTexture"] = {{"index", 0}};
    std::vector<float> first(12, 0), third(12, 0);
    for (std::size_t i = 0; i < 12; ++i) {
        first[i] = 0.125F * static_cast<float>(i);
        third[i] = -first[i];
    }
    attributes(file)["TEXCOORD_0"] = file.add_floats("VEC2", first);
    attributes(file)["TEXCOORD_3"] = file.add_floats("VEC2", third);
    attributes(file)["TEXCOORD_2"] = file.add_floats("VEC2", third);
    const ImportResult result = import(file);
    const Mesh& mesh = result.scene.meshes[0];
    ASSERT_EQ(mesh.texcoords.size(), 4U);
    EXPECT_TRUE(mesh.texcoords[2].empty());
    EXPECT_EQ(mesh.texcoords[3][5], Vec2f(third[10], third[11]));
    EXPECT_EQ(result.scene.materials[0].diffuse_texture->texcoord, 3U);
    EXPECT_TRUE(contains(sentences(result.report), "ignored: attribute TEXCOORD_2 at "));
    const PreparedScene prepared = prepare(result.scene);
    const MaterialTextures& textures = prepared.textures.materials.at(prepared.material_of[0]);
    EXPECT_EQ(textures.normal.slot, 0U);
    EXPECT_EQ(textures.diffuse.slot, 1U);
    // by slot, then by corner
    const std::uint32_t corner = mesh.triangles[1];
    EXPECT_EQ(prepared.texcoords[1], mesh.texcoords[0][corner]);
    EXPECT_EQ(prepared.texcoords[3 + 1], mesh.texcoords[3][corner]);
}

TEST_F(Appearance, ANumberOfCoordinatesBeyondAllIsNoMemory) {
    TestFile file = test::pictured_mesh_file();
    material(file)["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}, {"texCoord", 4000000000U}};
    const ImportResult result = import(file);
    EXPECT_FALSE(result.scene.materials[0].diffuse_texture);
    EXPECT_TRUE(contains(sentences(result.report), "it uses TEXCOORD_4000000000; Tandem reads up to TEXCOORD_15"));
}

TEST_F(Appearance, EmissiveTexturesMultiplyTheEmission) {
    TestFile file = test::pictured_mesh_file();
    material(file)["emissiveTexture"] = {{"index", 0}};
    material(file)["emissiveFactor"] = {1, 0.5, 0.25};
    attributes(file)["TEXCOORD_0"] = file.add_floats("VEC2", {0, 0, 1, 0, 0, 1, 1, 1, 0.2F, 0.8F, 0.4F, 0.1F});
    const ImportResult result = import(file);
    ASSERT_TRUE(result.scene.materials[0].emissive_texture);
    EXPECT_TRUE(contains(sentences(result.report), "rendered: emissive texture at materials[0].emissiveTexture: sRGB"));
    const PreparedScene prepared = prepare(result.scene);
    EXPECT_NE(prepared.textures.materials.at(0).emission.texture, no_texture);
    EXPECT_EQ(prepared.area_lights.size(), 2U);
    material(file).erase("emissiveFactor");
    const ImportResult dark = import(file);
    EXPECT_FALSE(dark.scene.materials[0].emissive_texture);
    EXPECT_TRUE(contains(sentences(dark.report), "the emissiveFactor that multiplies it is 0"));
    EXPECT_TRUE(prepare(dark.scene).area_lights.empty());
}

TEST_F(Appearance, UnlitMaterialsNeitherReceiveNorEmitLight) {
    TestFile file = mesh_file();
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_materials_unlit"};
    material(file)["extensions"] = {{"KHR_materials_unlit", Json::object()}};
    material(file)["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.25, 1, 1};
    const ImportResult result = import(file);
    EXPECT_TRUE(contains(sentences(result.report),
                         "rendered: KHR_materials_unlit at materials[0].extensions.KHR_materials_unlit: "));
    const PreparedScene prepared = prepare(result.scene);
    EXPECT_EQ(prepared.optics[0].emission, Vec3f(0.5F, 0.25F, 1));
    EXPECT_EQ(prepared.optics[0].unlit, 1U);
    EXPECT_EQ(prepared.materials[0].diffuse, Vec3f(0, 0, 0));
    EXPECT_EQ(prepared.materials[0].ambient, Vec3f(0, 0, 0));
    EXPECT_TRUE(prepared.area_lights.empty());
    EXPECT_TRUE(prepared.effects.has(Effect::emission));
}

TEST_F(Appearance, BacksOfSingleSidedFacesAreCulled) {
    TestFile file = mesh_file();
    EXPECT_EQ(import(file).scene.materials[0].sides, FaceSides::single_sided) << "TANDEM_materials_phong lights backs";
    material(file).erase("extensions");
    const ImportResult result = import(file);
    EXPECT_EQ(result.scene.materials[0].sides, FaceSides::culled);
    EXPECT_TRUE(contains(sentences(result.report), "rendered: single-sided faces at meshes[0].primitives[0]: "));
    const PreparedScene prepared = prepare(result.scene);
    EXPECT_EQ(prepared.triangles[0].attributes.sides, FaceSides::culled);
    EXPECT_TRUE(prepared.effects.has(Effect::cutouts));
    material(file)["doubleSided"] = true;
    EXPECT_EQ(import(file).scene.materials[0].sides, FaceSides::double_sided);
    EXPECT_FALSE(prepare(import(file).scene).effects.has(Effect::cutouts));
    material(file)["doubleSided"] = false;
    material(file)["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
    EXPECT_EQ(import(file).scene.materials[0].sides, FaceSides::single_sided) << "the far side of glass is there";
}

}  // namespace
}  // namespace tandem
