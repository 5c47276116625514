#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <functional>
#include <limits>

#include "gltf/files.h"

namespace tandem {
namespace {

using test::contains;
using test::Json;
using test::rich_file;
using test::small_file;
using test::TestFile;

struct Flaw {
    const char* name;
    std::function<void(Json&)> make;
    const char* path;      ///< how the sentence begins: the JSON path
    const char* sentence;  ///< a part of it
};

void PrintTo(const Flaw& flaw, std::ostream* out) { *out << flaw.name; }

class MalformedDocument : public test::GltfFiles, public testing::WithParamInterface<Flaw> {};

TEST_P(MalformedDocument, IsNamedInOneSentence) {
    TestFile file = rich_file();
    file.json = Json::parse(file.text());  // with its buffer
    GetParam().make(file.json);
    const std::string error = error_of(file);
    EXPECT_EQ(error.rfind(std::string(GetParam().path) + ": ", 0), 0U) << error;
    EXPECT_TRUE(contains(error, GetParam().sentence));
}

const auto flaw_name = [](const auto& info) { return std::string(info.param.name); };

INSTANTIATE_TEST_SUITE_P(
    Types, MalformedDocument,
    testing::Values(
        Flaw{"no_asset", [](Json& d) { d.erase("asset"); }, "root", "lacks the required property 'asset'"},
        Flaw{"asset", [](Json& d) { d["asset"] = 2; }, "asset", "must be an object, but is 2"},
        Flaw{"nodes", [](Json& d) { d["nodes"] = Json::object(); }, "nodes", "an array of objects, but is an object"},
        Flaw{"node", [](Json& d) { d["nodes"][1] = "ball"; }, "nodes[1]", "must be an object, but is \"ball\""},
        Flaw{"name", [](Json& d) { d["nodes"][1]["name"] = 7; }, "nodes[1].name", "must be a string"},
        Flaw{"translation",
             [](Json& d) {
                 d["nodes"][0]["translation"] = {1, 2};
             },
             "nodes[0].translation", "3 numb"},
        Flaw{"number",
             [](Json& d) {
                 d["nodes"][0]["translation"] = {1, nullptr, 2};
             },
             "nodes[0].translation[1]", "must be a number, but is null"},
        Flaw{"too_large",
             [](Json& d) {
                 d["nodes"][0]["translation"] = {1, 1e300, 2};
             },
             "nodes[0].translation[1]", "must be a number"},
        Flaw{"matrix", [](Json& d) { d["nodes"][1]["matrix"] = {1}; }, "nodes[1].matrix", "must be 16 numbers"},
        Flaw{"extensions", [](Json& d) { d["nodes"][1]["extensions"] = 1; }, "nodes[1].extensions", "an object"},
        Flaw{"extension",
             [](Json& d) {
                 d["nodes"][1]["extensions"] = {{"ACME", 1}};
             },
             "nodes[1].extensions.ACME", "must be an object"},
        Flaw{"normalized", [](Json& d) { d["accessors"][0]["normalized"] = 1; }, "accessors[0].normalized", "or false"},
        Flaw{"used", [](Json& d) { d["extensionsUsed"] = {1}; }, "extensionsUsed[0]", "must be a string"},
        Flaw{"target", [](Json& d) { d["animations"][0]["channels"][0]["target"] = 1; },
             "animations[0].channels[0].target", "must be an object"},
        Flaw{"attributes", [](Json& d) { d["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {0}; },
             "nodes[2].extensions.EXT_mesh_gpu_instancing.attributes", "must be an object of indices"},
        Flaw{"yfov", [](Json& d) { d["cameras"][0]["perspective"]["yfov"] = 3.2; }, "cameras[0].perspective.yfov",
             "above 0 and up to 3.14159"},
        Flaw{"radius",
             [](Json& d) {
                 d["meshes"][0]["primitives"][0]["extensions"]["EXT_implicit_geometry"]["sphere"]["radius"] = 0;
             },
             "meshes[0].primitives[0].extensions.EXT_implicit_geometry.sphere.radius", "a number above 0"},
        Flaw{"diffuse",
             [](Json& d) {
                 d["materials"][0]["extensions"]["TANDEM_materials_phong"]["diffuse"] = {0, 2, 0};
             },
             "materials[0].extensions.TANDEM_materials_phong.diffuse[1]", "from 0 to 1"},
        Flaw{"lights", [](Json& d) { d["extensions"]["KHR_lights_punctual"]["lights"] = 1; },
             "extensions.KHR_lights_punctual.lights", "an array of objects"},
        Flaw{"image",
             [](Json& d) {
                 d["images"] = {{{"uri", 7}}};
             },
             "images[0].uri", "must be a string"}),
    flaw_name);

INSTANTIATE_TEST_SUITE_P(
    Indices, MalformedDocument,
    testing::Values(
        Flaw{"scene", [](Json& d) { d["scene"] = 1; }, "scene", "is 1, but the file's array 'scenes' has 1 elements"},
        Flaw{"mesh", [](Json& d) { d["nodes"][1]["mesh"] = 7; }, "nodes[1].mesh", "use 0 to 1"},
        Flaw{"negative", [](Json& d) { d["nodes"][1]["mesh"] = -1; }, "nodes[1].mesh", "a whole number of 0 or more"},
        Flaw{"fraction", [](Json& d) { d["nodes"][1]["mesh"] = 0.5; }, "nodes[1].mesh", "a whole number"},
        Flaw{"huge", [](Json& d) { d["nodes"][1]["mesh"] = 18446744073709551615ULL; }, "nodes[1].mesh", "use 0 to 1"},
        Flaw{"child",
             [](Json& d) {
                 d["nodes"][1]["children"] = {2, 9};
             },
             "nodes[1].children[1]", "is 9"},
        Flaw{"twice",
             [](Json& d) {
                 d["nodes"][1]["children"] = {2, 2};
             },
             "nodes[1].children[1]", "a second time"},
        Flaw{"light", [](Json& d) { d["nodes"][3]["extensions"]["KHR_lights_punctual"]["light"] = 1; },
             "nodes[3].extensions.KHR_lights_punctual.light", "'extensions.KHR_lights_punctual.lights' has 1"},
        Flaw{"no_lights", [](Json& d) { d.erase("extensions"); }, "nodes[3].extensions.KHR_lights_punctual.light",
             "has 0 elements"},
        Flaw{"shape",
             [](Json& d) {
                 d["meshes"][0]["primitives"][0]["extensions"] = {{"KHR_implicit_shapes", {{"shape", 0}}}};
             },
             "meshes[0].primitives[0].extensions.KHR_implicit_shapes.shape", "has 0 elements"},
        Flaw{"material", [](Json& d) { d["meshes"][0]["primitives"][0]["material"] = 1; },
             "meshes[0].primitives[0].material", "use 0 to 0"},
        Flaw{"sampler", [](Json& d) { d["animations"][0]["channels"][0]["sampler"] = 1; },
             "animations[0].channels[0].sampler", "the animation has 1 samplers"},
        Flaw{"instances",
             [](Json& d) { d["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = 99; },
             "nodes[2].extensions.EXT_mesh_gpu_instancing.attributes.TRANSLATION", "use 0 to 3"},
        Flaw{"triangle", [](Json& d) { d["meshes"][0]["primitives"][0]["indices"] = 99; },
             "meshes[0].primitives[0].indices", "use 0 to 3"},
        Flaw{"view", [](Json& d) { d["accessors"][0]["bufferView"] = 4; }, "accessors[0].bufferView", "use 0 to 3"}),
    flaw_name);

INSTANTIATE_TEST_SUITE_P(
    Structure, MalformedDocument,
    testing::Values(
        Flaw{"version", [](Json& d) { d["asset"]["version"] = "1.0"; }, "asset.version", "Tandem reads glTF 2.0"},
        Flaw{"least_version", [](Json& d) { d["asset"]["minVersion"] = "2.1"; }, "asset.minVersion", "2.1"},
        Flaw{"required", [](Json& d) { d["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
             "extensionsRequired[0]", "the file requires KHR_draco_mesh_compression"},
        Flaw{"cycle", [](Json& d) { d["nodes"][2]["children"] = {1}, d["scenes"][0]["nodes"] = {0}; }, "nodes[1]",
             "is its own ancestor"},
        Flaw{"own_child", [](Json& d) { d["nodes"][3]["children"] = {3}, d["scenes"][0]["nodes"] = {0}; }, "nodes[3]",
             "is its own ancestor"},
        Flaw{"two_parents", [](Json& d) { d["nodes"][3]["children"] = {2}; }, "nodes[3].children[0]",
             "node 2 is already a child of node 1"},
        Flaw{"root_child",
             [](Json& d) {
                 d["scenes"][0]["nodes"] = {0, 2};
             },
             "scenes[0].nodes[1]", "node 2 is a child of node 1"},
        Flaw{"both", [](Json& d) { d["nodes"][0]["matrix"] = Json(std::vector<int>(16, 1)); }, "nodes[0].translation",
             "stands beside a matrix"},
        Flaw{"projective", [](Json& d) { d["nodes"][2]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
             "nodes[2].matrix", "must be affine"},
        Flaw{"camera", [](Json& d) { d["cameras"][0]["type"] = "orthographic"; }, "cameras[0]",
             "lacks the object 'orthographic'"},
        Flaw{"camera_type", [](Json& d) { d["cameras"][0]["type"] = "fisheye"; }, "cameras[0].type",
             "one of perspective orthographic, but is \"fisheye\""},
        Flaw{"path", [](Json& d) { d["animations"][0]["channels"][0]["target"]["path"] = "colour"; },
             "animations[0].channels[0].target.path", "use translation, rotation, scale or weights"},
        Flaw{"twice_driven", [](Json& d) { d["animations"][0]["channels"][1] = d["animations"][0]["channels"][0]; },
             "animations[0].channels[1]", "drives the scale of node 1 a second time"},
        Flaw{"two_shapes",
             [](Json& d) {
                 d["meshes"][0]["primitives"][0]["extensions"]["EXT_implicit_geometry"]["box"]["size"] = {1, 1, 1};
             },
             "meshes[0].primitives[0].extensions.EXT_implicit_geometry", "has 2 shapes; it must have one"},
        Flaw{"shape_types",
             [](Json& d) {
                 d["extensions"]["KHR_implicit_shapes"]["shapes"] = {{{"type", "box"}, {"sphere", Json::object()}}};
                 d["meshes"][0]["primitives"][0]["extensions"] = {{"KHR_implicit_shapes", {{"shape", 0}}}};
             },
             "extensions.KHR_implicit_shapes.shapes[0]", "is of type 'box' and has the parameters of another"},
        Flaw{"no_attributes",
             [](Json& d) { d["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = Json::object(); },
             "nodes[2].extensions.EXT_mesh_gpu_instancing.attributes", "neither TRANSLATION nor"},
        Flaw{"frame_rate", [](Json& d) { d["scenes"][0]["extras"]["frames_per_second"] = -1; },
             "scenes[0].extras.frames_per_second", "must be a number from 0.001"}),
    flaw_name);

INSTANTIATE_TEST_SUITE_P(
    Data, MalformedDocument,
    testing::Values(
        Flaw{"forged_count", [](Json& d) { d["accessors"][0]["count"] = 4000000000000ULL; }, "accessors[0]",
             "needs 48000000000000 bytes for its 4000000000000 elements, but bufferView 0 has 36"},
        Flaw{"largest_count", [](Json& d) { d["accessors"][0]["count"] = 18446744073709551615ULL; },
             "accessors[0].count", "a whole number"},
        Flaw{"zero_count", [](Json& d) { d["accessors"][0]["count"] = 0; }, "accessors[0].count", "a whole number"},
        Flaw{"forged_zeros",
             [](Json& d) { d["accessors"][0]["count"] = 4000000, d["accessors"][0].erase("bufferView"); },
             "nodes[2].extensions.EXT_mesh_gpu_instancing.attributes.ROTATION", "has 3 instances, but TRANSLATION"},
        Flaw{"huge_zeros",
             [](Json& d) { d["accessors"][0]["count"] = 4000000000ULL, d["accessors"][0].erase("bufferView"); },
             "nodes[2].extensions.EXT_mesh_gpu_instancing.attributes.TRANSLATION", "more than ten million times"},
        Flaw{"offset", [](Json& d) { d["accessors"][0]["byteOffset"] = 1; }, "accessors[0]", "needs 37 bytes"},
        Flaw{"view", [](Json& d) { d["bufferViews"][0]["byteLength"] = 4000; }, "bufferViews[0]", "but buffer 0 has"},
        Flaw{"view_offset", [](Json& d) { d["bufferViews"][0]["byteOffset"] = 9007199254740991ULL; }, "bufferViews[0]",
             "reaches from byte 9007199254740991"},
        Flaw{"stride", [](Json& d) { d["bufferViews"][0]["byteStride"] = 6; }, "bufferViews[0].byteStride",
             "a multiple of 4"},
        Flaw{"small_stride", [](Json& d) { d["bufferViews"][0]["byteStride"] = 4; }, "accessors[0]",
             "has elements of 12 bytes, but bufferView 0 steps by 4"},
        Flaw{"component", [](Json& d) { d["accessors"][0]["componentType"] = 5124; }, "accessors[0].componentType",
             "one of 5120 5121 5122 5123 5125 5126"},
        Flaw{"type", [](Json& d) { d["accessors"][0]["type"] = "VEC7"; }, "accessors[0].type", "one of SCALAR"},
        Flaw{"wrong_type", [](Json& d) { d["accessors"][0]["type"] = "VEC2"; }, "accessors[0]",
             "is of type VEC2, but an instance attribute"},
        Flaw{"not_normalised", [](Json& d) { d["accessors"][1]["normalized"] = false; }, "accessors[1]",
             "needs floats (5126) or normalised bytes or shorts"},
        Flaw{"integer_times",
             [](Json& d) { d["accessors"][2]["componentType"] = 5122, d["accessors"][2]["normalized"] = true; },
             "accessors[2]", "of type 5122, normalised, but the times of animation keys"},
        Flaw{"unequal", [](Json& d) { d["accessors"][1]["count"] = 2; },
             "nodes[2].extensions.EXT_mesh_gpu_instancing.attributes.ROTATION", "has 2 instances, but TRANSLATION has"},
        Flaw{"key_count", [](Json& d) { d["accessors"][2]["count"] = 2; }, "animations[0].samplers[0]",
             "has 2 keys and 3 values"},
        Flaw{"key_order",
             [](Json& d) {
                 d["animations"][0]["samplers"][0]["input"] = 4,
                 d["accessors"].push_back({{"count", 3}, {"type", "SCALAR"}, {"componentType", 5126}});
             },
             "animations[0].samplers[0].input", "do not rise strictly"},
        Flaw{"sparse_count",
             [](Json& d) {
                 d["accessors"][0]["sparse"] = {{"count", 4},
                                                {"indices", {{"bufferView", 0}, {"componentType", 5121}}},
                                                {"values", {{"bufferView", 0}}}};
             },
             "accessors[0].sparse.count", "is 4, more than the accessor's 3 elements"},
        Flaw{"sparse_index",
             [](Json& d) {
                 d["accessors"][0]["sparse"] = {{"count", 3},
                                                {"indices", {{"bufferView", 0}, {"componentType", 5123}}},
                                                {"values", {{"bufferView", 0}}}};
             },
             "accessors[0].sparse.indices", "entry 1 is 16256, but the accessor has 3 elements"},
        Flaw{"sparse_extent",
             [](Json& d) {
                 d["accessors"][0]["sparse"] = {{"count", 3},
                                                {"indices", {{"bufferView", 0}, {"componentType", 5125}}},
                                                {"values", {{"bufferView", 0}, {"byteOffset", 4}}}};
             },
             "accessors[0].sparse.values", "needs 40 bytes"},
        Flaw{"buffer_length", [](Json& d) { d["buffers"][0]["byteLength"] = 4000000000000ULL; },
             "buffers[0].byteLength", "is 4000000000000, but its data URI has"},
        Flaw{"short_buffer", [](Json& d) { d["buffers"][0]["byteLength"] = 3; }, "bufferViews[0]", "buffer 0 has 3"}),
    flaw_name);

class Malformed : public test::GltfFiles {
  protected:
    std::string error_of_bytes(const std::string& bytes) const { return error_of(write("scene.gltf", bytes)); }
};

TEST_F(Malformed, NumbersThatAreNotFinite) {
    TestFile file = rich_file();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    file.data.replace(4, 4, test::bytes_of(std::vector<float>{nan}));
    EXPECT_TRUE(contains(error_of(file), "accessors[0]: element 0 holds a number that is not finite"));
    std::string text = small_file().text();
    text.replace(text.find("0.8"), 3, "1e999");
    EXPECT_TRUE(contains(error_of_bytes(text), "is not well-formed JSON: number overflow"));
}

TEST_F(Malformed, ScenesThatAreNotValidNameTheNode) {
    TestFile file = small_file();
    file.json["nodes"][1]["rotation"] = {0, 0, 0, 0};
    EXPECT_TRUE(contains(error_of(file), "the scene is not valid: node 'ball' has the rotation (0, 0, 0, 0)"));
}

TEST_F(Malformed, WhatIsNoFile) {
    const auto message = [](const std::filesystem::path& file) {
        return test::input_error([&] { (void)import_gltf(file); });
    };
    const std::string none = (folder_ / "none.gltf").string();
    EXPECT_EQ(message(none), "cannot read '" + none + "': No such file or directory");
    EXPECT_TRUE(contains(message(folder_), "it is not a regular file"));
    const auto pipe = folder_ / "pipe.gltf";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_TRUE(contains(message(pipe), "it is not a regular file"));
}

TEST_F(Malformed, WhatIsNoJson) {
    EXPECT_TRUE(contains(error_of_bytes(""), "is empty"));
    EXPECT_TRUE(contains(error_of_bytes("[]"), "does not hold a JSON object"));
    EXPECT_TRUE(contains(error_of_bytes("{\"asset\": "), "is not well-formed JSON: parse error at line 1"));
    EXPECT_TRUE(contains(error_of_bytes(std::string("{\"\xff\": 1}")), "is not well-formed JSON"));
    EXPECT_TRUE(contains(error_of_bytes(std::string(64, '\0')), "is not well-formed JSON"));
}

TEST_F(Malformed, DeepNesting) {
    for (const std::size_t depth : {std::size_t{100}, std::size_t{3'000'000}}) {
        const std::string open = "{\"asset\": {\"version\": \"2.0\"}, \"extras\": " + std::string(depth, '[');
        EXPECT_TRUE(contains(error_of_bytes(open), "nests its JSON deeper than 64 levels"));
    }
}

/// Brackets in strings, also behind escaped quotes, are no nesting; 64 levels are allowed.
TEST_F(Malformed, NestingCountsBracketsOutsideOfStrings) {
    TestFile file = small_file();
    file.json["extras"] = "\\\"" + std::string(100, '[') + "\"\\";
    file.json["nodes"][1]["name"] = std::string(100, '{');
    EXPECT_EQ(import(file).scene.nodes[1].name, std::string(100, '{'));
    const auto nested = [&](std::size_t levels) {
        return small_file().text().insert(1,
                                          "\"extras\": " + std::string(levels, '[') + std::string(levels, ']') + ",");
    };
    EXPECT_EQ(import_gltf(write("scene.gltf", nested(63))).scene.nodes.size(), 2U);
    EXPECT_TRUE(contains(error_of_bytes(nested(64)), "deeper than 64 levels"));
}

TEST_F(Malformed, EveryTruncationOfATextAndABinaryFile) {
    const std::string text = rich_file().text();
    for (std::size_t length = 0; length + 1 < text.size(); length += 7) error_of_bytes(text.substr(0, length));
    const std::string binary = rich_file().glb();
    for (std::size_t length = 0; length < binary.size(); ++length) error_of_bytes(binary.substr(0, length));
}

TEST_F(Malformed, ContainersOfGlb) {
    const std::string json = small_file().text();
    const auto changed = [&](std::size_t at, std::uint32_t word) {
        std::string bytes = rich_file().glb();
        bytes.replace(at, 4, test::bytes_of(std::vector<std::uint32_t>{word}));
        return error_of_bytes(bytes);
    };
    EXPECT_TRUE(contains(changed(4, 1), "is a .glb file of version 1"));
    EXPECT_TRUE(contains(changed(8, 12), "says in its header that it has 12 bytes"));
    EXPECT_TRUE(contains(changed(12, 0xFFFFFFFF), "says that its first chunk has 4294967295 bytes"));
    EXPECT_TRUE(contains(changed(12, 4), "may be truncated"));
    EXPECT_TRUE(contains(changed(16, 0x004E4942), "whose first chunk is not the JSON"));
    EXPECT_TRUE(contains(error_of_bytes("glTF"), "too short"));
    TestFile file = rich_file();
    file.json["buffers"] = {{{"byteLength", file.data.size() + 5}}};
    EXPECT_TRUE(contains(error_of_bytes(test::make_glb(file.json.dump(), file.data)), "buffers[0].byteLength: is"));
    EXPECT_TRUE(contains(error_of_bytes(test::make_glb(file.json.dump(), "")), "the file has no binary chunk"));
    file.json["buffers"] = {{{"byteLength", file.data.size()}}, {{"byteLength", 4}}};
    EXPECT_TRUE(contains(error_of_bytes(test::make_glb(file.json.dump(), file.data)), "buffers[1].uri: is absent"));
}

/// Work that grows with the square of these would not end.
TEST_F(Malformed, ManyThingsTakeNotLong) {
    TestFile file = small_file();
    constexpr std::size_t many = 50'000;
    for (std::size_t i = 0; i < many; ++i) {
        file.json["nodes"][1]["extensions"]["ACME_" + std::to_string(i)] = Json::object();
        const std::size_t last = file.json["nodes"].size() - 1;
        file.json["nodes"].push_back({{"rotation", {0, 0, 0, 1}}});
        file.json["nodes"][last]["children"] = {last + 1};  // a very deep tree
    }
    const ImportResult result = import(file);
    EXPECT_EQ(result.scene.nodes.size(), many + 2);
    EXPECT_GT(result.report.notes().size(), many);
    file.json["nodes"][many + 1]["rotation"] = {0, 0, 0, 0};
    file.json["nodes"][many]["rotation"] = {0, 0, 0, 0};
    EXPECT_TRUE(contains(error_of(file), "which is none; use (0, 0, 0, 1); and 1 more"));
}

/// A few words of JSON must not become gigabytes.
TEST_F(Malformed, RepetitionIsBounded) {
    TestFile file = rich_file();
    Json& primitives = file.json["meshes"][1]["primitives"];
    for (int i = 0; i < 400; ++i) primitives.push_back(primitives[0]);
    const std::size_t places = file.add_floats("VEC3", std::vector<float>(90'000, 1));
    file.json["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", places}};
    EXPECT_TRUE(contains(error_of(file), "nodes[2].mesh: repeats the data of the file more than ten million times"));
}

}  // namespace
}  // namespace tandem
