#include "tandem/gltf/import.h"

#include <gtest/gtest.h>
#include <algorithm>

#include <cmath>
#include <numbers>

#include "gltf/files.h"
#include "support/thrown_message.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/images/image_io.h"

namespace tandem {
namespace {

using test::bytes_of;
using test::contains;
using test::Json;
using test::rich_file;
using test::sentences;
using test::small_file;
using test::TestFile;

class Import : public test::GltfFiles {};

TEST_F(Import, TakesNamesNodesAndShapes) {
    const Scene scene = import(small_file()).scene;
    EXPECT_EQ(scene.name, "small");
    ASSERT_EQ(scene.nodes.size(), 2U);
    EXPECT_EQ(scene.nodes[0].name, "eye");
    EXPECT_EQ(scene.nodes[0].trs.translation, Vec3d(0, 0, 5));
    EXPECT_EQ(std::get<PerspectiveCamera>(*scene.nodes[0].camera).yfov, 0.8);
    ASSERT_EQ(scene.nodes[1].geometry.size(), 1U);
    EXPECT_EQ(std::get<SphereShape>(scene.nodes[1].geometry[0].shape).radius, 1);
    EXPECT_EQ(scene.frames_per_second, 24);
}

TEST_F(Import, ReadsGlbAsItReadsGltf) {
    const auto text = import(rich_file());
    const auto binary = import_gltf(write("scene.glb", rich_file().glb()));
    EXPECT_EQ(sentences(text.report), sentences(binary.report));
    for (const int frame : {0, 13, 48}) {
        EXPECT_EQ(scene_hash(prepare(text.scene, {frame, ""})), scene_hash(prepare(binary.scene, {frame, ""})));
    }
}

TEST_F(Import, ReadsBuffersBesideTheFile) {
    TestFile file = rich_file();
    const auto embedded = import(file);
    file.json["buffers"] = {{{"uri", "data/a%20buffer.bin"}, {"byteLength", file.data.size()}}};
    write("data/a buffer.bin", file.data + "more than needed");
    const auto beside = import(file);
    EXPECT_EQ(scene_hash(prepare(embedded.scene, {9, ""})), scene_hash(prepare(beside.scene, {9, ""})));
}

TEST_F(Import, ComposesTheHierarchyOfTrsAndMatrices) {
    TestFile file = small_file();
    file.json["nodes"][1]["matrix"] = {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 7, 8, 9, 1};  // columns
    file.json["nodes"][1]["children"] = {2};
    file.json["nodes"].push_back({{"mesh", 0}, {"translation", {1, 0, 0}}, {"scale", {3, 3, 3}}});
    const Scene scene = import(file).scene;
    EXPECT_EQ(scene.nodes[2].parent, 1);
    const auto prepared = prepare(scene);
    ASSERT_EQ(prepared.spheres.size(), 2U);
    EXPECT_EQ(prepared.spheres[1].centre, Vec3f(7, 10, 9));
    EXPECT_EQ(prepared.spheres[1].radius, 6);
}

TEST_F(Import, RotationsAreXyzw) {
    TestFile file = small_file();
    const double half = std::numbers::pi / 8;
    file.json["nodes"][1]["rotation"] = {0, 0, std::sin(half), std::cos(half)};
    const Quaternion q = import(file).scene.nodes[1].trs.rotation;
    EXPECT_EQ(q.z, std::sin(half));
    EXPECT_EQ(q.w, std::cos(half));
}

TEST_F(Import, ReadsOrthographicCameras) {
    TestFile file = small_file();
    file.json["cameras"][0] =
        Json::parse(R"({"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "zfar": 10, "znear": 0}})");
    EXPECT_EQ(std::get<OrthographicCamera>(*import(file).scene.nodes[0].camera).ymag, 2);
}

TEST_F(Import, ReadsPointLights) {
    TestFile file = rich_file();
    file.json["extensions"]["KHR_lights_punctual"]["lights"][0]["color"] = {1, 0.5, 0.25};
    const Scene scene = import(file).scene;
    ASSERT_TRUE(scene.nodes[3].light);
    EXPECT_EQ(scene.nodes[3].light->colour, Vec3f(1, 0.5F, 0.25F));
    EXPECT_FLOAT_EQ(scene.nodes[3].light->intensity, static_cast<float>(2 / std::numbers::pi));
    EXPECT_TRUE(scene.nodes[3].light->inverse_square);
    EXPECT_TRUE(scene.nodes[3].light->casts_shadows);
}

TEST_F(Import, ReadsSpotAndDirectionalLights) {
    TestFile file = rich_file();
    Json& light = file.json["extensions"]["KHR_lights_punctual"]["lights"][0];
    light = Json::parse(R"({"type": "spot", "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.5}})");
    const LightSource spot = *import(file).scene.nodes[3].light;
    EXPECT_EQ(spot.kind, LightKind::spot);
    EXPECT_EQ(spot.inner_cone, 0.2);
    EXPECT_EQ(spot.outer_cone, 0.5);
    light = Json::parse(R"({"type": "directional", "intensity": 3})");
    const LightSource sun = *import(file).scene.nodes[3].light;
    EXPECT_EQ(sun.kind, LightKind::directional);
    EXPECT_FALSE(sun.inverse_square);
    light = Json::parse(R"({"type": "spot", "spot": {"innerConeAngle": 0.6, "outerConeAngle": 0.5}})");
    const auto sharp = import(file);
    EXPECT_EQ(sharp.scene.nodes[3].light->outer_cone, 0.5);
    EXPECT_NEAR(sharp.scene.nodes[3].light->inner_cone, 0.5, 1e-3);
    EXPECT_TRUE(
        contains(sentences(sharp.report), "approximated: cone of a spot light at nodes[3].extensions.KHR_lights"));
    light = Json::parse(R"({"type": "spot"})");
    EXPECT_EQ(import(file).scene.nodes[3].light->outer_cone, std::numbers::pi / 4);
}

TEST_F(Import, ReadsLightsAsPhongSeesThem) {
    TestFile file = rich_file();
    Json& light = file.json["extensions"]["KHR_lights_punctual"]["lights"][0];
    light["extensions"]["TANDEM_lights_phong"] = {{"falloff", false}, {"shadows", false}};
    const LightSource source = *import(file).scene.nodes[3].light;
    EXPECT_EQ(source.intensity, 2);
    EXPECT_FALSE(source.inverse_square);
    EXPECT_FALSE(source.casts_shadows);
}

TEST_F(Import, ReadsLenses) {
    TestFile file = small_file();
    Json& lens = file.json["cameras"][0]["extensions"]["TANDEM_camera_lens"];
    lens = {{"apertureRadius", 0.25}, {"focusDistance", 3}, {"blades", 6}, {"rotation", 0.5}};
    const Lens read = std::get<PerspectiveCamera>(*import(file).scene.nodes[0].camera).lens;
    EXPECT_EQ(read.aperture_radius, 0.25);
    EXPECT_EQ(read.focus_distance, 3);
    EXPECT_EQ(read.blades, 6);
    EXPECT_EQ(read.rotation, 0.5);
    lens["blades"] = 2;
    EXPECT_THROW((void)import(file), InputError);
}

TEST_F(Import, ReadsShutters) {
    TestFile file = small_file();
    Json& camera = file.json["cameras"][0];
    Json& shutter = camera["extensions"]["TANDEM_camera_shutter"];
    shutter = {{"open", -0.01}, {"close", 0.02}};
    const auto read = [&] { return shutter_of(*import(file).scene.nodes[0].camera); };
    EXPECT_EQ(read().open, -0.01);
    EXPECT_EQ(read().close, 0.02);
    EXPECT_EQ(read().instants, 16);
    shutter["instants"] = 5;
    EXPECT_EQ(read().instants, 5);
    shutter["close"] = -0.02;
    const auto message = test::thrown_message<InputError>([&] { (void)import(file); });
    EXPECT_NE(message.find("cameras[0].extensions.TANDEM_camera_shutter.close"), std::string::npos) << message;
    camera = {{"type", "orthographic"},
              {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 9}}},
              {"extensions", {{"TANDEM_camera_shutter", {{"open", 0}, {"close", 1}}}}}};
    EXPECT_EQ(read().close, 1);
}

TEST_F(Import, TakesComputedLightInPlaceOfTheAmbientTerm) {
    TestFile file = small_file();
    Json& environment = file.json["scenes"][0]["extensions"]["TANDEM_environment"];
    environment = {{"illuminates", true}};
    EXPECT_EQ(import(file).scene.environment.ambient, Vec3f(0, 0, 0));
    EXPECT_EQ(import(file).scene.environment.illuminates, 1U);
    environment = {{"indirect", true}, {"ambient", {0.5, 0.5, 0.5}}};
    EXPECT_EQ(import(file).scene.environment.ambient, Vec3f(0.5F, 0.5F, 0.5F));
    EXPECT_TRUE(import(file).scene.indirect_light);
}

TEST_F(Import, ReadsMirrorsAndGlass) {
    TestFile file = small_file();
    Json& extensions = file.json["materials"][0]["extensions"];
    extensions["TANDEM_materials_phong"] = {{"mirror", {0.1, 0.2, 0.3}}};
    extensions["KHR_materials_transmission"] = {{"transmissionFactor", 0.75}};
    extensions["KHR_materials_ior"] = {{"ior", 1.25}};
    extensions["KHR_materials_volume"] = {
        {"thicknessFactor", 1}, {"attenuationDistance", 2}, {"attenuationColor", {1, 0.5, 0.25}}};
    extensions["TANDEM_materials_dielectric"] = {{"priority", 7}};
    const Optics optics = import(file).scene.materials[0].optics;
    EXPECT_EQ(optics.mirror, Vec3f(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(optics.transmission, 0.75F);
    EXPECT_EQ(optics.ior, 1.25F);
    EXPECT_EQ(optics.absorption.x, 0);
    EXPECT_FLOAT_EQ(optics.absorption.y, static_cast<float>(std::numbers::ln2 / 2));
    EXPECT_FLOAT_EQ(optics.absorption.z, static_cast<float>(std::numbers::ln2));
    EXPECT_EQ(optics.priority, 7U);
    file.json["materials"][0]["emissiveFactor"] = {1, 0.5, 0.25};
    extensions["KHR_materials_emissive_strength"] = {{"emissiveStrength", 4}};
    EXPECT_EQ(import(file).scene.materials[0].optics.emission, Vec3f(4, 2, 1));
    extensions["TANDEM_materials_dielectric"] = {{"priority", 128}};
    EXPECT_THROW((void)import(file), InputError);
}

TEST_F(Import, ReadsPhongMaterialsWithTandemsDefaults) {
    TestFile file = small_file();
    Json& phong = file.json["materials"][0]["extensions"]["TANDEM_materials_phong"];
    const PhongMaterial partial = import(file).scene.materials[0].phong;
    EXPECT_EQ(partial.diffuse, Vec3f(0.5F, 0.25F, 0.125F));
    EXPECT_EQ(partial.ambient, PhongMaterial{}.ambient);
    EXPECT_EQ(partial.shininess, PhongMaterial{}.shininess);
    phong = {{"ambient", {0.1, 0.2, 0.3}}, {"specular", {0, 0.5, 1}}, {"shininess", 7.5}};
    const PhongMaterial whole = import(file).scene.materials[0].phong;
    EXPECT_EQ(whole.ambient, Vec3f(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(whole.specular, Vec3f(0, 0.5F, 1));
    EXPECT_EQ(whole.shininess, 7.5F);
}

TEST_F(Import, ReadsMetallicRoughness) {
    TestFile file = small_file();
    file.json["materials"][0] = {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0.75, 1}}}}};
    const Material absent = import(file).scene.materials[0];
    EXPECT_EQ(absent.phong.diffuse, Vec3f(0.5F, 0.25F, 0.75F));
    EXPECT_EQ(absent.phong.ambient, Vec3f(0.5F, 0.25F, 0.75F) * 0.1F);
    ASSERT_TRUE(absent.microfacets);
    EXPECT_EQ(absent.microfacets->metallic, 1) << "the default of glTF";
    EXPECT_EQ(absent.microfacets->roughness, 1) << "the default of glTF";
    Json& pbr = file.json["materials"][0]["pbrMetallicRoughness"];
    pbr["metallicFactor"] = 0.25;
    pbr["roughnessFactor"] = 0;
    file.json["materials"][0]["extensions"]["KHR_materials_ior"] = {{"ior", 1.75}};
    const ImportResult read = import(file);
    EXPECT_EQ(read.scene.materials[0].microfacets->metallic, 0.25F);
    EXPECT_EQ(read.scene.materials[0].microfacets->roughness, 0);
    EXPECT_EQ(read.scene.materials[0].optics.ior, 1.75F);
    EXPECT_TRUE(prepare(read.scene).effects.has(Effect::microfacets));
    EXPECT_NE(test::sentences(read.report)
                  .find("rendered: metallic-roughness material at materials[0]: reflection from GGX microfacets"),
              std::string::npos);
}

TEST_F(Import, ReadsAnisotropy) {
    TestFile file = small_file();
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_materials_anisotropy"};
    Json& material = file.json["materials"][0];
    material = {{"pbrMetallicRoughness", {{"roughnessFactor", 0.5}}}};
    Json& anisotropy = material["extensions"]["KHR_materials_anisotropy"];
    anisotropy = {{"anisotropyStrength", 0.75}, {"anisotropyRotation", -1.5}};
    const ImportResult read = import(file);
    EXPECT_EQ(read.scene.materials[0].microfacets->anisotropy, 0.75F);
    EXPECT_EQ(read.scene.materials[0].microfacets->rotation, -1.5F);
    EXPECT_TRUE(prepare(read.scene).effects.has(Effect::anisotropy));
    const auto expect_note = [&](const std::string& note) {
        const ImportResult result = import(file);
        const std::string all = test::sentences(result.report);
        EXPECT_TRUE(test::contains(all, note)) << all;
        return result.scene.materials[0];
    };
    const std::string path = "KHR_materials_anisotropy at materials[0].extensions.KHR_materials_anisotropy: ";
    expect_note("rendered: " + path + "the tangent is where u of the texture coordinates grows");
    anisotropy = {{"anisotropyStrength", 2}, {"anisotropyRotation", "left"}};
    const Material mended = expect_note("KHR_materials_anisotropy.anisotropyStrength: ");
    EXPECT_EQ(mended.microfacets->anisotropy, 1) << "the nearest";
    EXPECT_EQ(mended.microfacets->rotation, 0);
    expect_note("KHR_materials_anisotropy.anisotropyRotation: must be a number");
    anisotropy = Json::object();
    EXPECT_EQ(expect_note("rendered: " + path + "its strength is 0").microfacets->anisotropy, 0);
    anisotropy = {{"anisotropyStrength", 1}};
    material["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 0.5}};
    EXPECT_FALSE(expect_note("ignored: " + path + "the material has no microfacets").microfacets);
}

TEST_F(Import, ReadsSheen) {
    TestFile file = small_file();
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_materials_sheen"};
    Json& material = file.json["materials"][0];
    material = {{"pbrMetallicRoughness", {{"roughnessFactor", 0.5}}}};
    Json& sheen = material["extensions"]["KHR_materials_sheen"];
    sheen = {{"sheenColorFactor", {0.5, 0.25, 1}}, {"sheenRoughnessFactor", 0.75}};
    const auto expect_note = [&](const std::string& note) {
        const ImportResult result = import(file);
        const std::string all = test::sentences(result.report);
        EXPECT_TRUE(test::contains(all, note)) << all;
        return result.scene;
    };
    const std::string path = "KHR_materials_sheen at materials[0].extensions.KHR_materials_sheen: ";
    const Scene read = expect_note("rendered: " + path + "a layer of fibres");
    ASSERT_TRUE(read.materials[0].sheen);
    EXPECT_EQ(read.materials[0].sheen->colour, Vec3f(0.5F, 0.25F, 1));
    EXPECT_EQ(read.materials[0].sheen->roughness, 0.75F);
    EXPECT_TRUE(prepare(read).effects.has(Effect::sheen));
    sheen["sheenRoughnessFactor"] = 7;
    EXPECT_EQ(expect_note("KHR_materials_sheen.sheenRoughnessFactor: ").materials[0].sheen->roughness, 1);
    sheen = Json::object();
    EXPECT_FALSE(expect_note("rendered: " + path + "its colour is black").materials[0].sheen);
    sheen = {{"sheenColorFactor", {1, 1, 1}}};
    EXPECT_EQ(expect_note("rendered: " + path).materials[0].sheen->roughness, 0) << "the default of glTF";
    material["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 0.5}};
    EXPECT_FALSE(expect_note("ignored: " + path + "mirrors and dielectrics").materials[0].sheen);
    material["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 0}};
    material["extensions"]["KHR_materials_unlit"] = Json::object();
    EXPECT_FALSE(expect_note("ignored: " + path + "an unlit material").materials[0].sheen);
}

TEST_F(Import, GlassAndUnlitMaterialsHaveNoMicrofacets) {
    TestFile file = small_file();
    file.json["materials"][0] = {{"pbrMetallicRoughness", {{"metallicFactor", 0.5}, {"roughnessFactor", 0.5}}}};
    const auto expect_none = [&](const char* sentence) {
        const ImportResult read = import(file);
        EXPECT_FALSE(read.scene.materials[0].microfacets) << sentence;
        EXPECT_NE(test::sentences(read.report).find(sentence), std::string::npos) << sentence;
    };
    file.json["materials"][0]["extensions"] = {{"KHR_materials_transmission", {{"transmissionFactor", 0.5}}}};
    expect_none(
        "ignored: roughnessFactor at materials[0].pbrMetallicRoughness.roughnessFactor: dielectrics have smooth "
        "surfaces");
    expect_none("approximated: metallic-roughness material at materials[0]: a dielectric");
    file.json["materials"][0]["extensions"] = {{"KHR_materials_unlit", Json::object()}};
    expect_none("ignored: metallicFactor at materials[0].pbrMetallicRoughness.metallicFactor: an unlit material");
    file.json["materials"][0]["extensions"] = {{"TANDEM_materials_phong", Json::object()}};
    expect_none("ignored: metallicFactor at materials[0].pbrMetallicRoughness.metallicFactor: TANDEM_materials_phong");
    file.json["materials"][0]["extensions"] = {{"KHR_materials_transmission", {{"transmissionFactor", 0}}}};
    EXPECT_TRUE(import(file).scene.materials[0].microfacets) << "nothing passes through it";
}

TEST_F(Import, PrimitivesWithoutMaterialShareOneWhiteOne) {
    TestFile file = small_file();
    file.json["meshes"][0]["primitives"][0].erase("material");
    file.json["meshes"][0]["primitives"].push_back(file.json["meshes"][0]["primitives"][0]);
    const Scene scene = import(file).scene;
    ASSERT_EQ(scene.materials.size(), 2U);
    EXPECT_EQ(scene.nodes[1].geometry[0].material, 1U);
    EXPECT_EQ(scene.nodes[1].geometry[1].material, 1U);
    EXPECT_EQ(scene.materials[1].phong.diffuse, Vec3f(1, 1, 1));
}

TEST_F(Import, TheEnvironmentOfTheSceneGoesBeforeTheFiles) {
    TestFile file = small_file();
    file.json["extensions"]["TANDEM_environment"] =
        Json::parse(R"({"gradient": {"bottom": [0, 0, 0], "top": [1, 2, 3]}, "ambient": [0.5, 0.5, 0.5]})");
    const Environment of_file = import(file).scene.environment;
    EXPECT_EQ(of_file.top, Vec3f(1, 2, 3));
    EXPECT_EQ(of_file.ambient, Vec3f(0.5F, 0.5F, 0.5F));
    file.json["scenes"][0]["extensions"]["TANDEM_environment"] = Json::parse(R"({"ambient": [2, 2, 2]})");
    const Environment of_scene = import(file).scene.environment;
    EXPECT_EQ(of_scene.top, Environment{}.top);
    EXPECT_EQ(of_scene.ambient, Vec3f(2, 2, 2));
}

TEST_F(Import, ReadsThePictureOfTheEnvironment) {
    write_image((folder_ / "sky.pfm").string(), FloatImage{2, 1, {{1, 2, 3}, {4, -5, 6}}}, {});
    write_image((folder_ / "sky.png").string(), FloatImage{1, 1, {{1, 1, 1}}}, {});
    TestFile file = small_file();
    Json& environment = file.json["scenes"][0]["extensions"]["TANDEM_environment"];
    environment = {{"uri", "sky.pfm"}, {"rotation", 0.5}, {"intensity", 2}};
    const ImportResult result = import(file);
    ASSERT_TRUE(result.scene.environment_image);
    EXPECT_EQ(result.scene.environment_image->picture.pixels, (std::vector<Vec3f>{{1, 2, 3}, {4, 0, 6}}));
    EXPECT_EQ(result.scene.environment_image->rotation, 0.5);
    EXPECT_EQ(result.scene.environment_image->intensity, 2.0F);
    EXPECT_EQ(result.scene.environment.illuminates, 1U);
    EXPECT_EQ(result.scene.environment.ambient, Vec3f(0, 0, 0));
    const std::vector<ImportNote>& notes = result.report.notes();
    EXPECT_TRUE(std::any_of(notes.begin(), notes.end(),
                            [](const ImportNote& note) { return test::contains(to_string(note), "negative"); }));
    environment["illuminates"] = false;
    EXPECT_EQ(import(file).scene.environment.illuminates, 0U);
    for (const auto& [uri, reason] : {std::pair{"none.hdr", "none.hdr"}, std::pair{"sky.png", "8 bits"},
                                      std::pair{"../sky.pfm", "folder"}, std::pair{"data:,1", "embeds"}}) {
        environment = {{"uri", uri}};
        const std::string message = test::input_error([&] { (void)import(file); });
        EXPECT_TRUE(test::contains(message, "scenes[0].extensions.TANDEM_environment.uri"));
        EXPECT_TRUE(test::contains(message, reason));
    }
}

TEST_F(Import, ReadsHowPicturesAreMeant) {
    TestFile file = small_file();
    EXPECT_EQ(import(file).scene.display, Display{});
    file.json["extensions"]["TANDEM_display"] = {{"transfer", "linear"}, {"exposure", -2.5}};
    EXPECT_EQ(import(file).scene.display, (Display{TransferFunction::linear, -2.5}));
    file.json["scenes"][0]["extensions"]["TANDEM_display"] = {{"exposure", 1}};
    const ImportResult of_scene = import(file);
    EXPECT_EQ(of_scene.scene.display, (Display{TransferFunction::srgb, 1})) << "the scene's goes before the file's";
    const std::string report = test::sentences(of_scene.report);
    for (const char* sentence :
         {"rendered: TANDEM_display at scenes[0].extensions.TANDEM_display: 8-bit images are sRGB, exposed by +1 "
          "stops",
          "ignored: TANDEM_display of the file at extensions.TANDEM_display: the scene has its own"}) {
        EXPECT_NE(report.find(sentence), std::string::npos) << report;
    }
    file.json["scenes"][0]["extensions"]["TANDEM_display"] = {{"transfer", "gamma"}};
    EXPECT_NE(error_of(file).find("scenes[0].extensions.TANDEM_display.transfer: must be one of srgb linear"),
              std::string::npos)
        << error_of(file);
    file.json["scenes"][0]["extensions"]["TANDEM_display"] = {{"exposure", 101}};
    EXPECT_NE(error_of(file).find("scenes[0].extensions.TANDEM_display.exposure: must be a number from -100 to 100"),
              std::string::npos)
        << error_of(file);
}

TEST_F(Import, ReadsImplicitShapes) {
    TestFile file = small_file();
    file.json["extensions"]["KHR_implicit_shapes"]["shapes"] = Json::parse(
        R"([{"type": "sphere"}, {"type": "box", "box": {"size": [1, 2, 3]}}, {"type": "sphere", "sphere": {"radius": 2}},
            {"type": "capsule", "capsule": {}}, {"type": "box", "box": {}}])");
    Json primitives = Json::array();
    for (int shape = 0; shape < 5; ++shape) {
        primitives.push_back({{"material", 0}, {"extensions", {{"KHR_implicit_shapes", {{"shape", shape}}}}}});
    }
    file.json["meshes"][0]["primitives"] = primitives;
    const auto result = import(file);
    const std::vector<Geometry>& read = result.scene.nodes[1].geometry;
    ASSERT_EQ(read.size(), 4U);
    EXPECT_EQ(std::get<SphereShape>(read[0].shape).radius, 0.5);  // the defaults of the extension
    EXPECT_EQ(std::get<BoxShape>(read[1].shape).size, Vec3d(1, 2, 3));
    EXPECT_EQ(std::get<SphereShape>(read[2].shape).radius, 2);
    EXPECT_EQ(std::get<BoxShape>(read[3].shape).size, Vec3d(1, 1, 1));
    EXPECT_TRUE(contains(sentences(result.report), "ignored: KHR_implicit_shapes capsule at meshes[0].primitives[3]"));
}

TEST_F(Import, ReadsInstances) {
    const Scene scene = import(rich_file()).scene;
    const std::vector<Trs>& instances = scene.nodes[2].geometry[0].instances;
    ASSERT_EQ(instances.size(), 3U);
    EXPECT_EQ(instances[2].translation, Vec3d(3, 0, 0));
    EXPECT_EQ(instances[2].rotation.w, 1);
    EXPECT_EQ(instances[2].scale, Vec3d(1, 1, 1));
}

TEST_F(Import, NormalisedIntegersBecomeFloats) {
    const struct {
        int component_type;
        std::string bytes;
        std::vector<float> expected;
    } cases[] = {
        {5120, bytes_of(std::vector<std::int8_t>{127, -127, -128, 0}), {1, -1, -1, 0}},
        {5121, bytes_of(std::vector<std::uint8_t>{255, 0, 51, 255}), {1, 0, 0.2F, 1}},
        {5122, bytes_of(std::vector<std::int16_t>{32767, -32768, 0, 32767}), {1, -1, 0, 1}},
        {5123, bytes_of(std::vector<std::uint16_t>{65535, 0, 13107, 65535}), {1, 0, 0.2F, 1}},
    };
    for (const auto& c : cases) {
        TestFile file = rich_file();
        const std::size_t turn = file.add_bytes("VEC4", c.component_type, 1, c.bytes);
        file.json["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"ROTATION", turn}};
        const Quaternion q = import(file).scene.nodes[2].geometry[0].instances[0].rotation;
        EXPECT_EQ((std::vector<float>{static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z),
                                      static_cast<float>(q.w)}),
                  c.expected)
            << "component type " << c.component_type;
    }
}

TEST_F(Import, SparseAccessorsReplaceElements) {
    for (const bool has_view : {true, false}) {
        TestFile file = rich_file();
        const std::size_t places = file.add_floats("VEC3", {1, 1, 1, 2, 2, 2, 3, 3, 3});
        const std::size_t which = file.add_bytes("SCALAR", 5121, 1, std::string(1, '\1'));
        const std::size_t what = file.add_floats("VEC3", {7, 8, 9});
        const auto view_of = [&](std::size_t accessor) { return file.json["accessors"][accessor]["bufferView"]; };
        file.json["accessors"][places]["sparse"] = {
            {"count", 1},
            {"indices", {{"bufferView", view_of(which)}, {"componentType", 5121}}},
            {"values", {{"bufferView", view_of(what)}}}};
        if (!has_view) file.json["accessors"][places].erase("bufferView");
        file.json["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", places}};
        const Scene scene = import(file).scene;
        const auto& instances = scene.nodes[2].geometry[0].instances;
        ASSERT_EQ(instances.size(), 3U);
        EXPECT_EQ(instances[1].translation, Vec3d(7, 8, 9));
        EXPECT_EQ(instances[2].translation, has_view ? Vec3d(3, 3, 3) : Vec3d(0, 0, 0));
    }
}

TEST_F(Import, InterleavedViewsAreRead) {
    TestFile file = rich_file();
    const std::size_t places = file.add_floats("VEC3", {1, 2, 3, 9, 4, 5, 6, 9});  // one view, steps of 16 bytes
    const Json view = file.json["accessors"][places]["bufferView"];
    file.json["bufferViews"][view.get<std::size_t>()]["byteStride"] = 16;
    file.json["accessors"][places]["count"] = 2;
    file.json["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", places}};
    EXPECT_EQ(import(file).scene.nodes[2].geometry[0].instances[1].translation, Vec3d(4, 5, 6));
}

TEST_F(Import, ReadsAnimationsOfAllKinds) {
    TestFile file = rich_file();
    const std::size_t times = file.add_floats("SCALAR", {0, 2});
    const std::size_t turns =
        file.add_bytes("VEC4", 5120, 2, bytes_of(std::vector<std::int8_t>{0, 0, 0, 127, 127, 0, 0, 0}));
    const std::size_t splines = file.add_floats("VEC3", std::vector<float>(18, 1.5F));
    file.json["animations"][0] = {{"samplers",
                                   {{{"input", times}, {"output", turns}, {"interpolation", "STEP"}},
                                    {{"input", times}, {"output", splines}, {"interpolation", "CUBICSPLINE"}},
                                    {{"input", times}, {"output", turns}}}},
                                  {"channels",
                                   {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}},
                                    {{"sampler", 1}, {"target", {{"node", 1}, {"path", "scale"}}}},
                                    {{"sampler", 2}, {"target", {{"node", 2}, {"path", "rotation"}}}}}}};
    const Scene scene = import(file).scene;
    ASSERT_EQ(scene.animation.size(), 3U);
    EXPECT_EQ(scene.animation[0].interpolation, Interpolation::step);
    EXPECT_EQ(scene.animation[0].path, AnimatedPath::rotation);
    EXPECT_EQ(scene.animation[0].values, (std::vector<float>{0, 0, 0, 1, 1, 0, 0, 0}));
    EXPECT_EQ(scene.animation[1].interpolation, Interpolation::cubic);
    EXPECT_EQ(scene.animation[1].node, 1U);
    EXPECT_EQ(scene.animation[2].interpolation, Interpolation::linear);
    EXPECT_EQ(scene.animation[2].times, (std::vector<float>{0, 2}));
}

TEST_F(Import, FrameRateComesFromTheExtrasOfTheScene) {
    TestFile file = rich_file();
    file.json["scenes"][0]["extras"]["frames_per_second"] = 30;
    EXPECT_EQ(import(file).scene.frames_per_second, 30);
    file.json["scenes"][0]["extras"] = "anything else";
    EXPECT_EQ(import(file).scene.frames_per_second, 24);
}

TEST_F(Import, TakesTheDefaultSceneAndLeavesTheOthers) {
    TestFile file = rich_file();
    file.json["scenes"] = {{{"nodes", {0}}}, {{"name", "second"}, {"nodes", {0, 3}}}};
    file.json["scene"] = 1;
    const auto result = import(file);
    EXPECT_EQ(result.scene.name, "second");
    ASSERT_EQ(result.scene.nodes.size(), 2U);
    EXPECT_EQ(result.scene.nodes[1].name, "lamp");
    EXPECT_TRUE(result.scene.animation.empty());  // it animates nodes that do not exist
    file.json.erase("scene");
    EXPECT_EQ(import(file).scene.nodes.size(), 1U);
    file.json.erase("scenes");
    const Scene all = import(file).scene;
    EXPECT_EQ(all.nodes.size(), 4U);
    EXPECT_EQ(all.nodes[2].parent, 1);
    EXPECT_EQ(all.name, "scene");
}

TEST_F(Import, NamelessNodesTakeTheNameOfWhatTheyCarry) {
    TestFile file = rich_file();
    for (Json& node : file.json["nodes"]) node.erase("name");
    file.json["cameras"][0]["name"] = "front";
    file.json["meshes"][0]["name"] = "marble";
    file.json["extensions"]["KHR_lights_punctual"]["lights"][0]["name"] = "sun";
    const Scene scene = import(file).scene;
    EXPECT_EQ(scene.nodes[0].name, "front");
    EXPECT_EQ(scene.nodes[1].name, "marble");
    EXPECT_EQ(scene.nodes[2].name, "");
    EXPECT_EQ(scene.nodes[3].name, "sun");
    EXPECT_FALSE(prepare(scene, {0, "front"}).camera.orthographic);
}

TEST_F(Import, WholeNumbersMayBeWrittenWithAPoint) {
    TestFile file = rich_file();
    file.json["nodes"][0]["camera"] = 0.0;
    file.json["accessors"][0]["count"] = 3.0;
    const Scene scene = import(file).scene;
    EXPECT_TRUE(scene.nodes[0].camera);
    EXPECT_EQ(scene.nodes[2].geometry[0].instances.size(), 3U);
}

}  // namespace
}  // namespace tandem
