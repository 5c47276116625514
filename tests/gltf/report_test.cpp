#include "tandem/gltf/report.h"

#include <gtest/gtest.h>

#include "gltf/files.h"

namespace tandem {
namespace {

using test::contains;
using test::Json;
using test::rich_file;
using test::sentences;
using test::small_file;
using test::TestFile;

TEST(ImportReport, JoinsUsesOfOneFeature) {
    ImportReport report;
    report.add(Treatment::ignored, "image", "images[0]", "no textures");
    report.add(Treatment::rendered, "image", "images[1]", "no textures");
    report.add(Treatment::ignored, "image", "images[2]", "no textures");
    EXPECT_EQ(sentences(report),
              "ignored: image at images[0] (2 uses): no textures\nrendered: image at images[1]: no textures\n");
}

TEST(ImportReport, KeepsControlCharactersFromTheTerminal) {
    ImportReport report;
    report.add(Treatment::ignored, "bell\a\x1b[31m", "nodes[0].extensions.a\nb", "straße");
    EXPECT_EQ(sentences(report), "ignored: bell??[31m at nodes[0].extensions.a?b: straße\n");
}

class Report : public test::GltfFiles {
  protected:
    void expect(const TestFile& file, const std::string& sentence) const {
        EXPECT_TRUE(contains(sentences(import(file).report), sentence));
    }
};

TEST_F(Report, SaysWhatIsRendered) {
    const std::string all = sentences(import(rich_file()).report);
    for (const char* sentence :
         {"rendered: EXT_implicit_geometry sphere at meshes[0].primitives[0].extensions.EXT_implicit_geometry: ",
          "rendered: EXT_implicit_geometry box at meshes[1].primitives[0].extensions.EXT_implicit_geometry: ",
          "rendered: EXT_mesh_gpu_instancing at nodes[2].extensions.EXT_mesh_gpu_instancing: ",
          "rendered: TANDEM_materials_phong at materials[0].extensions.TANDEM_materials_phong: ",
          "rendered: TANDEM_environment at extensions.TANDEM_environment: ",
          "rendered: perspective camera at nodes[0].camera: ",
          "rendered: animation of scale at animations[0].channels[0]: ",
          "rendered: animation of translation at animations[0].channels[1]: ",
          "rendered: KHR_lights_punctual point at nodes[3].extensions.KHR_lights_punctual: ",
          "approximated: default material at meshes[1].primitives[0]: ",
          "approximated: frame rate at animations[0]: glTF has none; Tandem uses 24 frames per second",
          "ignored: camera znear at cameras[0].perspective.znear: "}) {
        EXPECT_TRUE(contains(all, sentence));
    }
}

TEST_F(Report, EveryLineHasAPathAndAReason) {
    const ImportReport report = import(rich_file()).report;
    for (const ImportNote& note : report.notes()) {
        EXPECT_FALSE(note.feature.empty());
        EXPECT_FALSE(note.json_path.empty()) << note.feature;
        EXPECT_FALSE(note.reason.empty()) << note.feature;
    }
}

TEST_F(Report, NamesTexturesSkinsAndMorphTargets) {
    TestFile file = small_file();
    const std::size_t places = file.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    const Json attributes = {{"POSITION", places}};
    file.json["meshes"].push_back(
        {{"weights", {0.5}},
         {"primitives",
          {{{"attributes", attributes}, {"targets", {attributes}}}, {{"attributes", attributes}, {"mode", 1}}}}});
    file.json["nodes"][1]["mesh"] = 1;
    file.json["nodes"][1]["skin"] = 0;
    file.json["skins"] = {{{"joints", {0}}}};
    file.json["images"] = {{{"uri", "../../../../etc/passwd"}}};  // never opened
    file.json["samplers"] = {Json::object()};
    file.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
    file.json["materials"][0]["pbrMetallicRoughness"] = {{"metallicRoughnessTexture", {{"index", 0}}},
                                                         {"metallicFactor", 1}};
    file.json["materials"][0]["occlusionTexture"] = {{"index", 0}};
    file.json["materials"][0]["emissiveFactor"] = {1, 1, 1};
    for (const char* sentence :
         {"rendered: triangle mesh at meshes[1].primitives[0]: ", "ignored: lines at meshes[1].primitives[1]: ",
          "ignored: morph targets at meshes[1].primitives[0].targets: ",
          "ignored: morph weights at meshes[1].weights: ", "ignored: skin at nodes[1].skin: the mesh has no JOINTS_0",
          "ignored: image at images[0]: ", "ignored: texture sampler at samplers[0]: ",
          "ignored: texture at textures[0]: ",
          "ignored: metallic-roughness texture at materials[0].pbrMetallicRoughness.metallicRoughnessTexture: ",
          "ignored: occlusion texture at materials[0].occlusionTexture: ",
          "ignored: metallicFactor at materials[0].pbrMetallicRoughness.metallicFactor: ",
          "rendered: emission at materials[0].emissiveFactor: "}) {
        expect(file, sentence);
    }
}

TEST_F(Report, NamesWhatCamerasAndLightsLeaveOut) {
    TestFile file = rich_file();
    file.json["cameras"][0]["perspective"]["aspectRatio"] = 1.5;
    file.json["cameras"][0]["perspective"]["zfar"] = 100;
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(
        R"([{"type": "point", "range": 10}, {"type": "spot", "spot": {}}, {"type": "directional"}, {"type": "area"}])");
    for (int light = 1; light < 4; ++light) {
        file.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
        file.json["scenes"][0]["nodes"].push_back(light + 3);
    }
    for (const char* sentence :
         {"ignored: camera aspectRatio at cameras[0].perspective.aspectRatio: the size of the film determines",
          "ignored: camera zfar at cameras[0].perspective.zfar: ",
          "ignored: light range at extensions.KHR_lights_punctual.lights[0].range: ",
          "rendered: KHR_lights_punctual spot at nodes[4].extensions.KHR_lights_punctual: ",
          "rendered: KHR_lights_punctual directional at nodes[5].extensions.KHR_lights_punctual: ",
          "ignored: KHR_lights_punctual area at nodes[6].extensions.KHR_lights_punctual: "}) {
        expect(file, sentence);
    }
}

TEST_F(Report, NamesOrthographicLeftovers) {
    TestFile file = small_file();
    file.json["cameras"][0] =
        Json::parse(R"({"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "zfar": 10, "znear": 0}})");
    expect(file, "ignored: camera xmag at cameras[0].orthographic.xmag: the size of the film determines");
    expect(file, "rendered: orthographic camera at nodes[0].camera: ");
}

TEST_F(Report, NamesWhatAnimationsLeaveOut) {
    TestFile file = rich_file();
    Json animation = file.json["animations"][0];
    Json& channels = animation["channels"];
    channels.push_back({{"sampler", 0}, {"target", {{"node", 1}, {"path", "weights"}}}});
    channels.push_back({{"sampler", 0}, {"target", {{"path", "translation"}}}});
    channels.push_back(Json::parse(
        R"({"sampler": 0, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/x"}}}})"));
    channels.push_back({{"sampler", 0}, {"target", {{"node", 4}, {"path", "scale"}}}});
    file.json["nodes"].push_back(Json::object());
    file.json["animations"] = Json::array({animation, animation});
    for (const char* sentence :
         {"ignored: animation of weights at animations[0].channels[2]: ",
          "ignored: animation without a node at animations[0].channels[3]: ",
          "ignored: KHR_animation_pointer at animations[0].channels[4].target.extensions.KHR_animation_pointer",
          "ignored: animation of a node outside of the scene at animations[0].channels[5]: ",
          "ignored: further animation at animations[1]: ", "ignored: node outside of the scene at nodes[4]: "}) {
        expect(file, sentence);
    }
}

TEST_F(Report, NamesOtherShapesAndAttributes) {
    TestFile file = rich_file();
    Json& sphere = file.json["meshes"][0]["primitives"][0]["extensions"]["EXT_implicit_geometry"];
    sphere = {{"cylinder", {{"radius", 1}, {"height", 2}}}};
    file.json["meshes"][1]["primitives"][0]["extensions"]["EXT_implicit_geometry"]["box"]["slice"] = Json::object();
    Json& instancing = file.json["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"];
    instancing["attributes"]["_ID"] = 0;
    file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = instancing;
    file.json["extensions"]["KHR_implicit_shapes"]["shapes"] = {{{"type", "sphere"}}};
    for (const char* sentence :
         {"ignored: EXT_implicit_geometry cylinder at meshes[0].primitives[0].extensions.EXT_implicit_geometry: ",
          "ignored: implicit geometry slice at meshes[1].primitives[0].extensions.EXT_implicit_geometry.box.slice: ",
          "ignored: instance attribute _ID at nodes[2].extensions.EXT_mesh_gpu_instancing.attributes._ID: ",
          "ignored: EXT_mesh_gpu_instancing at nodes[0].extensions.EXT_mesh_gpu_instancing: the node has no mesh",
          "ignored: KHR_implicit_shapes shape at extensions.KHR_implicit_shapes.shapes[0]: no mesh primitive"}) {
        expect(file, sentence);
    }
}

TEST_F(Report, NamesUnknownExtensionsWhereverTheyAre) {
    TestFile file = small_file();
    file.json["extensionsUsed"] = {"ACME_sparkle", "ACME_unused", "KHR_materials_clearcoat"};
    file.json["nodes"][1]["extensions"]["ACME_sparkle"] = {{"extensions", 3}, {"camera", {1, 2}}};
    file.json["materials"][0]["extensions"]["KHR_materials_clearcoat"] = Json::object();
    expect(file, "ignored: ACME_sparkle at nodes[1].extensions.ACME_sparkle: Tandem does not support it");
    expect(file, "ignored: ACME_unused at extensionsUsed[1]: the file lists it but does not use it");
    expect(file,
           "ignored: KHR_materials_clearcoat at materials[0].extensions.KHR_materials_clearcoat: Tandem renders base "
           "colour");
}

/// It is used, though not where it counts.
TEST_F(Report, SaysOfAnExtensionThatItIsInsideOfAnIgnoredOne) {
    TestFile file = small_file();
    file.json["extensionsUsed"] = {"KHR_materials_specular", "KHR_texture_transform"};
    file.json["materials"][0]["extensions"]["KHR_materials_specular"] =
        Json::parse(R"({"specularTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"scale": [2, 2]}}}})");
    const std::string all = sentences(import(file).report);
    EXPECT_TRUE(
        contains(all,
                 "ignored: KHR_texture_transform at materials[0].extensions.KHR_materials_specular.specularTexture."
                 "extensions.KHR_texture_transform: it is inside KHR_materials_specular, which is ignored"));
    EXPECT_EQ(all.find("uses it nowhere"), std::string::npos) << all;
}

TEST_F(Report, DoesNotSayOfAnExtensionWithAFlawThatItIsUsedNowhere) {
    TestFile file = small_file();
    file.json["extensionsUsed"] = {"KHR_materials_ior"};
    file.json["materials"][0]["extensions"]["KHR_materials_ior"] = "glass";
    const std::string all = sentences(import(file).report);
    EXPECT_TRUE(
        contains(all, "ignored: KHR_materials_ior at materials[0].extensions.KHR_materials_ior: must be an object"));
    EXPECT_EQ(all.find("uses it nowhere"), std::string::npos) << all;
}

TEST_F(Report, SaysThatASurfaceEmitsWhereItDoes) {
    TestFile file = small_file();
    Json& material = file.json["materials"][0];
    material["emissiveFactor"] = {0, 0, 0};
    material["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", 5}};
    const std::string dark = sentences(import(file).report);
    EXPECT_EQ(dark.find("rendered: emission"), std::string::npos) << dark;
    EXPECT_TRUE(contains(dark, "ignored: KHR_materials_emissive_strength at materials[0].extensions."));
    material["emissiveFactor"] = {0, 3, 0};
    const ImportResult bright = import(file);
    EXPECT_EQ(bright.scene.materials[0].optics.emission, Vec3f(0, 15, 0));
    expect(file, "rendered: emission at materials[0].emissiveFactor: ");
    expect(file,
           "rendered: emissiveFactor at materials[0].emissiveFactor[1]: is 3; glTF allows 1 at most, but Tandem "
           "accepts it");
    material["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", 0}};
    EXPECT_EQ(sentences(import(file).report).find("rendered: emission at"), std::string::npos);
}

TEST_F(Report, SaysThatAMaterialIsADielectricWhereItIs) {
    TestFile file = small_file();
    Json& extensions = file.json["materials"][0]["extensions"];
    extensions["KHR_materials_transmission"] = {{"transmissionFactor", 0}};
    extensions["KHR_materials_volume"] = {{"thicknessFactor", 1}};
    const std::string all = sentences(import(file).report);
    EXPECT_EQ(all.find("a dielectric"), std::string::npos) << all;
    EXPECT_TRUE(contains(all,
                         "ignored: KHR_materials_volume at materials[0].extensions.KHR_materials_volume: the material "
                         "transmits no light"));
}

TEST_F(Report, NamesAPlaceForTheFrameRateThatIsThere) {
    TestFile file = rich_file();
    expect(file, "uses 24 frames per second unless scenes[0].extras.frames_per_second says otherwise");
    file.json.erase("scene");
    file.json.erase("scenes");
    const std::string all = sentences(import(file).report);
    EXPECT_TRUE(
        contains(all, "uses 24 frames per second; in a file with scenes, extras.frames_per_second of a scene sets it"));
    EXPECT_EQ(all.find("nodes.extras"), std::string::npos);
}

TEST_F(Report, SaysThatAnAnimationGoesOnBeyondTheLastFrame) {
    TestFile file = rich_file();
    const std::string sentence = "length of the animation";
    EXPECT_EQ(sentences(import(file).report).find(sentence), std::string::npos);
    const std::size_t times = file.add_floats("SCALAR", {0, 1, 1e30F});
    file.json["animations"][0]["samplers"][0]["input"] = times;
    const ImportResult result = import(file);
    EXPECT_EQ(frame_count(result.scene), 2147483647);
    expect(file,
           "approximated: length of the animation at animations[0]: its last key is at 1e+30 s, but the last possible "
           "frame");
}

TEST_F(Report, ClampsFactors) {
    TestFile file = small_file();
    Json& material = file.json["materials"][0];
    material.erase("extensions");
    material["pbrMetallicRoughness"] = {{"baseColorFactor", {1.5, -1, 0.5, 1}}};
    const ImportResult result = import(file);
    EXPECT_EQ(result.scene.materials[0].phong.diffuse, Vec3f(1, 0, 0.5F));
    expect(file,
           "approximated: baseColorFactor at materials[0].pbrMetallicRoughness.baseColorFactor[0]: must be a number "
           "from 0 to 1, but is 1.5; Tandem uses 1");
}

TEST_F(Report, NamesTheChoiceOfAScene) {
    TestFile file = small_file();
    file.json["scenes"].push_back({{"nodes", {1}}});
    expect(file, "ignored: further scene at scenes[1]: Tandem renders one scene of a file, here scenes[0]");
    file.json.erase("scene");
    expect(file, "approximated: no default scene at scenes: Tandem uses the first one");
    file.json.erase("scenes");
    expect(file, "approximated: file without scenes at nodes: the scene consists of all root nodes");
}

}  // namespace
}  // namespace tandem
