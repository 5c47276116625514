// Files that have flaws and can be drawn: what is left out or put right, and what the report says of it.
#include <gtest/gtest.h>

#include <algorithm>

#include "gltf/flawed_document.h"

namespace tandem {
namespace {

using test::contains;
using test::DocumentFlaw;
using test::flaw_name;
using test::Json;
using test::sentences;
using test::TestFile;

/// What can be drawn without the flawed part, as other viewers do.
class MendedDocument : public test::FlawedDocument {};

TEST_P(MendedDocument, IsDrawnWithANote) {
    const ImportResult result = import(flawed());
    const auto& notes = result.report.notes();
    const bool is_noted = std::any_of(notes.begin(), notes.end(), [](const ImportNote& note) {
        return note.json_path == GetParam().path && note.reason.find(GetParam().sentence) != std::string::npos;
    });
    EXPECT_TRUE(is_noted) << sentences(result.report);
    const auto has_geometry = [](const Node& node) { return !node.geometry.empty(); };
    EXPECT_TRUE(std::any_of(result.scene.nodes.begin(), result.scene.nodes.end(), has_geometry));
    EXPECT_TRUE(validate(result.scene).empty());
}

INSTANTIATE_TEST_SUITE_P(
    Types, MendedDocument,
    testing::Values(
        DocumentFlaw{"name", [](Json& d) { d["nodes"][1]["name"] = 7; }, "nodes[1].name", "must be a string"},
        DocumentFlaw{"extensions", [](Json& d) { d["nodes"][1]["extensions"] = 1; }, "nodes[1].extensions",
                     "an object"},
        DocumentFlaw{"extension",
                     [](Json& d) {
                         d["nodes"][1]["extensions"] = {{"ACME", 1}};
                     },
                     "nodes[1].extensions.ACME", "must be an object"},
        DocumentFlaw{"normalized", [](Json& d) { d["accessors"][0]["normalized"] = 1; }, "accessors[0].normalized",
                     "or false"},
        DocumentFlaw{"used", [](Json& d) { d["extensionsUsed"] = {1}; }, "extensionsUsed[0]", "must be a string"},
        DocumentFlaw{"target", [](Json& d) { d["animations"][0]["channels"][0]["target"] = 1; },
                     "animations[0].channels[0].target", "must be an object"},
        DocumentFlaw{"yfov", [](Json& d) { d["cameras"][0]["perspective"]["yfov"] = 3.2; },
                     "cameras[0].perspective.yfov", "above 0 and up to 3.14159"},
        DocumentFlaw{"radius",
                     [](Json& d) {
                         d["meshes"][0]["primitives"][0]["extensions"]["EXT_implicit_geometry"]["sphere"]["radius"] = 0;
                     },
                     "meshes[0].primitives[0].extensions.EXT_implicit_geometry.sphere.radius", "a number above 0"},
        DocumentFlaw{"lights", [](Json& d) { d["extensions"]["KHR_lights_punctual"]["lights"] = 1; },
                     "extensions.KHR_lights_punctual.lights", "an array of objects"},
        DocumentFlaw{"image",
                     [](Json& d) {
                         d["images"] = {{{"uri", 7}}};
                     },
                     "images[0].uri", "must be a string"}),
    flaw_name);

INSTANTIATE_TEST_SUITE_P(
    Indices, MendedDocument,
    testing::Values(
        DocumentFlaw{"scene", [](Json& d) { d["scene"] = 1; }, "scene",
                     "is 1, but the file's array 'scenes' has 1 elements"},
        DocumentFlaw{"mesh", [](Json& d) { d["nodes"][1]["mesh"] = 7; }, "nodes[1].mesh", "use 0 to 1"},
        DocumentFlaw{"negative", [](Json& d) { d["nodes"][1]["mesh"] = -1; }, "nodes[1].mesh",
                     "a whole number of 0 or more"},
        DocumentFlaw{"fraction", [](Json& d) { d["nodes"][1]["mesh"] = 0.5; }, "nodes[1].mesh", "a whole number"},
        DocumentFlaw{"huge", [](Json& d) { d["nodes"][1]["mesh"] = 18446744073709551615ULL; }, "nodes[1].mesh",
                     "use 0 to 1"},
        DocumentFlaw{"child",
                     [](Json& d) {
                         d["nodes"][1]["children"] = {2, 9};
                     },
                     "nodes[1].children[1]", "is 9"},
        DocumentFlaw{"twice",
                     [](Json& d) {
                         d["nodes"][1]["children"] = {2, 2};
                     },
                     "nodes[1].children[1]", "a second time"},
        DocumentFlaw{"light", [](Json& d) { d["nodes"][3]["extensions"]["KHR_lights_punctual"]["light"] = 1; },
                     "nodes[3].extensions.KHR_lights_punctual.light", "'extensions.KHR_lights_punctual.lights' has 1"},
        DocumentFlaw{"no_lights", [](Json& d) { d.erase("extensions"); },
                     "nodes[3].extensions.KHR_lights_punctual.light", "has 0 elements"},
        DocumentFlaw{"shape",
                     [](Json& d) {
                         d["meshes"][0]["primitives"][0]["extensions"] = {{"KHR_implicit_shapes", {{"shape", 0}}}};
                     },
                     "meshes[0].primitives[0].extensions.KHR_implicit_shapes.shape", "has 0 elements"},
        DocumentFlaw{"material", [](Json& d) { d["meshes"][0]["primitives"][0]["material"] = 1; },
                     "meshes[0].primitives[0].material", "use 0 to 0"},
        DocumentFlaw{"sampler", [](Json& d) { d["animations"][0]["channels"][0]["sampler"] = 1; },
                     "animations[0].channels[0].sampler", "the animation has 1 samplers"},
        DocumentFlaw{"triangle", [](Json& d) { d["meshes"][0]["primitives"][0]["indices"] = 99; },
                     "meshes[0].primitives[0].indices", "use 0 to 3"}),
    flaw_name);

// Each factor is a float, and the product is not.
INSTANTIATE_TEST_SUITE_P(
    Products, MendedDocument,
    testing::Values(
        DocumentFlaw{"light",
                     [](Json& d) {
                         Json& light = d["extensions"]["KHR_lights_punctual"]["lights"][0];
                         light["color"] = {1e30, 1, 0};
                         light["intensity"] = 1e30;
                     },
                     "nodes[3].extensions.KHR_lights_punctual", "color times its intensity is above"},
        DocumentFlaw{
            "emission",
            [](Json& d) {
                d["materials"][0]["emissiveFactor"] = {1e30, 1, 0};
                d["materials"][0]["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", 1e30}};
            },
            "materials[0].emissiveFactor", "times the emissiveStrength it is above"}),
    flaw_name);

INSTANTIATE_TEST_SUITE_P(
    Structure, MendedDocument,
    testing::Values(
        DocumentFlaw{"two_parents", [](Json& d) { d["nodes"][3]["children"] = {2}; }, "nodes[3].children[0]",
                     "node 2 is already a child of node 1"},
        DocumentFlaw{"root_child",
                     [](Json& d) {
                         d["scenes"][0]["nodes"] = {0, 2};
                     },
                     "scenes[0].nodes[1]", "node 2 is a child of node 1; the scene does not reach that node"},
        DocumentFlaw{"both", [](Json& d) { d["nodes"][0]["matrix"] = Json(std::vector<int>(16, 1)); },
                     "nodes[0].translation", "is given in addition to a matrix; Tandem uses the matrix"},
        DocumentFlaw{"projective",
                     [](Json& d) { d["nodes"][2]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
                     "nodes[2].matrix", "has a last row other than 0, 0, 0, 1"},
        DocumentFlaw{"camera", [](Json& d) { d["cameras"][0]["type"] = "orthographic"; }, "cameras[0]",
                     "lacks the object 'orthographic'"},
        DocumentFlaw{"camera_type", [](Json& d) { d["cameras"][0]["type"] = "fisheye"; }, "cameras[0].type",
                     "one of perspective orthographic, but is \"fisheye\""},
        DocumentFlaw{"path", [](Json& d) { d["animations"][0]["channels"][0]["target"]["path"] = "colour"; },
                     "animations[0].channels[0].target.path", "use translation, rotation, scale or weights"},
        DocumentFlaw{"twice_driven",
                     [](Json& d) { d["animations"][0]["channels"][1] = d["animations"][0]["channels"][0]; },
                     "animations[0].channels[1]", "animates the scale of node 1 a second time"},
        DocumentFlaw{
            "two_shapes",
            [](Json& d) {
                d["meshes"][0]["primitives"][0]["extensions"]["EXT_implicit_geometry"]["box"]["size"] = {1, 1, 1};
            },
            "meshes[0].primitives[0].extensions.EXT_implicit_geometry", "has 2 shapes; it must have one"},
        DocumentFlaw{
            "shape_types",
            [](Json& d) {
                d["extensions"]["KHR_implicit_shapes"]["shapes"] = {{{"type", "box"}, {"sphere", Json::object()}}};
                d["meshes"][0]["primitives"][0]["extensions"] = {{"KHR_implicit_shapes", {{"shape", 0}}}};
            },
            "extensions.KHR_implicit_shapes.shapes[0]", "is of type 'box' and has the parameters of another type"}),
    flaw_name);

INSTANTIATE_TEST_SUITE_P(
    Data, MendedDocument,
    testing::Values(
        DocumentFlaw{"view", [](Json& d) { d["bufferViews"][0]["byteLength"] = 4000; }, "bufferViews[0]",
                     "but buffer 0 has"},
        DocumentFlaw{"integer_times",
                     [](Json& d) { d["accessors"][2]["componentType"] = 5122, d["accessors"][2]["normalized"] = true; },
                     "accessors[2]", "of type 5122, normalised, but the times of animation keys"},
        DocumentFlaw{"key_count", [](Json& d) { d["accessors"][2]["count"] = 2; }, "animations[0].samplers[0]",
                     "has 2 keys and 3 values"},
        DocumentFlaw{"key_order",
                     [](Json& d) {
                         d["animations"][0]["samplers"][0]["input"] = 4,
                         d["accessors"].push_back({{"count", 3}, {"type", "SCALAR"}, {"componentType", 5126}});
                     },
                     "animations[0].samplers[0].input", "not strictly increasing"},
        DocumentFlaw{"buffer_length", [](Json& d) { d["buffers"][0]["byteLength"] = 4000000000000ULL; },
                     "buffers[0].byteLength", "is 4000000000000, but its data URI has"}),
    flaw_name);

class Mended : public test::GltfFiles {};

TEST_F(Mended, ChildrenThatTheSceneListsHangOnTheirParentIfItIsThere) {
    TestFile file = test::rich_file();
    file.json["scenes"][0]["nodes"] = {0, 2, 1};
    EXPECT_EQ(import(file).scene.nodes[2].parent, 1);
    file.json["scenes"][0]["nodes"] = {0, 2};
    const ImportResult result = import(file);
    ASSERT_EQ(result.scene.nodes.size(), 2U);
    EXPECT_EQ(result.scene.nodes[1].name, "crowd");
    EXPECT_EQ(result.scene.nodes[1].parent, Node::no_parent);
    EXPECT_TRUE(
        contains(sentences(result.report), "at scenes[0].nodes[1]: node 2 is a child of node 1; the scene does not"));
}

TEST_F(Mended, CyclesOfNodesAreCut) {
    TestFile file = test::rich_file();
    file.json["nodes"][2]["children"] = {1};
    const ImportResult result = import(file);
    EXPECT_EQ(result.scene.nodes.size(), 4U);
    EXPECT_EQ(result.scene.nodes[1].parent, Node::no_parent);
    EXPECT_EQ(result.scene.nodes[2].parent, 1);
    EXPECT_TRUE(contains(sentences(result.report), "ignored: cycle of nodes at nodes[1]: is its own ancestor"));
}

TEST_F(Mended, RotationsThatAreNone) {
    TestFile file = test::rich_file();
    file.json["nodes"][0]["rotation"] = {0, 0, 0, 0.0};
    const std::size_t turns = file.add_floats("VEC4", {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0});
    file.json["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] = turns;
    file.json["animations"][0]["samplers"].push_back({{"input", 2}, {"output", turns}});
    file.json["animations"][0]["channels"].push_back({{"sampler", 1}, {"target", {{"node", 3}, {"path", "rotation"}}}});
    const ImportResult result = import(file);
    EXPECT_EQ(result.scene.nodes[0].trs.rotation.w, 1);
    EXPECT_EQ(result.scene.nodes[2].geometry[0].instances[0].rotation.w, 1);
    EXPECT_EQ(result.scene.animation[2].values[3], 1);
    const std::string all = sentences(result.report);
    EXPECT_TRUE(contains(all, "approximated: rotation at nodes[0].rotation: is (0, 0, 0, 0)"));
    EXPECT_TRUE(contains(all, "approximated: rotation of an instance at nodes[2].extensions."));
    EXPECT_TRUE(contains(all, "approximated: rotation key at animations[0].samplers[1].output: "));
}

TEST_F(Mended, MatricesAreTakenAsAffine) {
    TestFile file = test::small_file();
    file.json["nodes"][1]["matrix"] = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 1e-9, 7, 8, 9, 0.99999994};
    const Node node = import(file).scene.nodes[1];
    ASSERT_TRUE(node.matrix);
    EXPECT_EQ(node.matrix->translation, Vec3d(7, 8, 9));
}

TEST_F(Mended, AnimatedNodesWithMatricesStay) {
    TestFile file = test::rich_file();
    file.json["nodes"][1]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const ImportResult result = import(file);
    EXPECT_EQ(result.scene.animation.size(), 1U);
    EXPECT_TRUE(
        contains(sentences(result.report), "at animations[0].channels[0]: animates node 1, which has a matrix"));
}

/// As exporters write them that know of no stride.
TEST_F(Mended, AStrideOfZeroIsNone) {
    TestFile file = test::rich_file();
    file.json["bufferViews"][0]["byteStride"] = 0;
    EXPECT_EQ(import(file).scene.nodes[2].geometry[0].instances[2].translation, Vec3d(3, 0, 0));
}

/// Buffer views of length 0, skins, animations and cameras that nothing on the way to the picture needs.
TEST_F(Mended, WhatNothingUsesDoesNotCount) {
    TestFile file = test::rich_file();
    Json& json = file.json;
    json["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 0}});
    json["accessors"].push_back({{"componentType", 1}, {"count", 3}, {"type", "SCALAR"}});
    json["accessors"].push_back(
        {{"componentType", 5126}, {"count", 3}, {"type", "SCALAR"}, {"min", 1}, {"max", {"a"}}});
    json["skins"] = {{{"joints", {77}}}};
    json["nodes"][1]["skin"] = 0;
    json["meshes"].push_back({{"name", 3}});
    json["animations"].push_back({{"channels", 1}, {"samplers", Json::array()}});
    json["cameras"].push_back({{"type", "fisheye"}});
    const ImportResult result = import(file);
    EXPECT_EQ(result.scene.animation.size(), 2U);
    const std::string all = sentences(result.report);
    for (const char* sentence :
         {"ignored: buffer view at bufferViews[4].byteLength: must be a whole number of 1 or more, but is 0",
          "ignored: accessor at accessors[4].componentType: must be one of 5120",
          "ignored: min at accessors[5].min: must be an array of numbers, but is 1",
          "ignored: max at accessors[5].max[0]: must be a number, but is \"a\"",
          "ignored: skin at skins[0].joints[0]: is 77",
          "ignored: skin at nodes[1].skin: names skins[0], which is left out (skins[0].joints[0]: is 77",
          "ignored: mesh at meshes[2]: lacks the required property 'primitives'",
          "ignored: animation at animations[1].channels: must be an array of objects",
          "ignored: camera at cameras[1].type: must be one of perspective orthographic"}) {
        EXPECT_TRUE(contains(all, sentence));
    }
}

/// Tandem's own extensions are for people who look for such errors.
TEST_F(Mended, NotSoForTandemsExtensions) {
    TestFile file = test::small_file();
    file.json["cameras"][0]["extensions"]["TANDEM_camera_lens"] = {{"apertureRadius", 1}, {"focusDistance", "far"}};
    EXPECT_TRUE(
        contains(error_of(file), "cameras[0].extensions.TANDEM_camera_lens.focusDistance: must be a number above 0"));
}

}  // namespace
}  // namespace tandem
