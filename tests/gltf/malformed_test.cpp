#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <limits>

#include "gltf/flawed_document.h"

namespace tandem {
namespace {

using test::contains;
using test::DocumentFlaw;
using test::flaw_name;
using test::Json;
using test::rich_file;
using test::small_file;
using test::TestFile;

/// What cannot be drawn.
class MalformedDocument : public test::FlawedDocument {};

TEST_P(MalformedDocument, IsNamedInOneSentence) {
    const std::string error = error_of(flawed());
    EXPECT_EQ(error.rfind(std::string(GetParam().path) + ": ", 0), 0U) << error;
    EXPECT_TRUE(contains(error, GetParam().sentence));
}

INSTANTIATE_TEST_SUITE_P(
    Types, MalformedDocument,
    testing::Values(
        DocumentFlaw{"no_asset", [](Json& d) { d.erase("asset"); }, "root", "lacks the required property 'asset'"},
        DocumentFlaw{"asset", [](Json& d) { d["asset"] = 2; }, "asset", "must be an object, but is 2"},
        DocumentFlaw{"nodes", [](Json& d) { d["nodes"] = Json::object(); }, "nodes",
                     "an array of objects, but is an object"},
        DocumentFlaw{"node", [](Json& d) { d["nodes"][1] = "ball"; }, "nodes[1]", "must be an object, but is \"ball\""},
        DocumentFlaw{"translation",
                     [](Json& d) {
                         d["nodes"][0]["translation"] = {1, 2};
                     },
                     "nodes[0].translation", "must be 3 numbers, but is an array of 2"},
        DocumentFlaw{"number",
                     [](Json& d) {
                         d["nodes"][0]["translation"] = {1, nullptr, 2};
                     },
                     "nodes[0].translation[1]", "must be a number, but is null"},
        DocumentFlaw{"too_large",
                     [](Json& d) {
                         d["nodes"][0]["translation"] = {1, 1e300, 2};
                     },
                     "nodes[0].translation[1]",
                     "must be a number from -3.4028234663852886e+38 to 3.4028234663852886e+38, but is 1e+300"},
        DocumentFlaw{"matrix", [](Json& d) { d["nodes"][1]["matrix"] = {1}; }, "nodes[1].matrix",
                     "must be 16 numbers, but is an array of 1"},
        DocumentFlaw{"attributes",
                     [](Json& d) { d["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {0}; },
                     "nodes[2].extensions.EXT_mesh_gpu_instancing.attributes", "must be an object of indices"},
        DocumentFlaw{"diffuse",
                     [](Json& d) {
                         d["materials"][0]["extensions"]["TANDEM_materials_phong"]["diffuse"] = {0, 2, 0};
                     },
                     "materials[0].extensions.TANDEM_materials_phong.diffuse[1]", "from 0 to 1"}),
    flaw_name);

INSTANTIATE_TEST_SUITE_P(
    Indices, MalformedDocument,
    testing::Values(
        DocumentFlaw{
            "instances",
            [](Json& d) { d["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = 99; },
            "nodes[2].extensions.EXT_mesh_gpu_instancing.attributes.TRANSLATION", "use 0 to 3"},
        DocumentFlaw{"view", [](Json& d) { d["accessors"][0]["bufferView"] = 4; }, "accessors[0].bufferView",
                     "use 0 to 3"}),
    flaw_name);

INSTANTIATE_TEST_SUITE_P(
    Structure, MalformedDocument,
    testing::Values(
        DocumentFlaw{"least_version", [](Json& d) { d["asset"]["minVersion"] = "2.1"; }, "asset.minVersion", "2.1"},
        DocumentFlaw{"required", [](Json& d) { d["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
                     "extensionsRequired[0]", "the file requires KHR_draco_mesh_compression"},
        DocumentFlaw{"cycle", [](Json& d) { d["nodes"][2]["children"] = {1}, d["scenes"][0]["nodes"] = {0}; },
                     "nodes[1]", "is its own ancestor"},
        DocumentFlaw{"own_child", [](Json& d) { d["nodes"][3]["children"] = {3}, d["scenes"][0]["nodes"] = {0}; },
                     "nodes[3]", "is its own ancestor"},
        DocumentFlaw{
            "no_attributes",
            [](Json& d) { d["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = Json::object(); },
            "nodes[2].extensions.EXT_mesh_gpu_instancing.attributes", "neither TRANSLATION nor"},
        DocumentFlaw{"frame_rate", [](Json& d) { d["scenes"][0]["extras"]["frames_per_second"] = -1; },
                     "scenes[0].extras.frames_per_second", "must be a number from 0.001"}),
    flaw_name);

INSTANTIATE_TEST_SUITE_P(
    Data, MalformedDocument,
    testing::Values(
        DocumentFlaw{"forged_count", [](Json& d) { d["accessors"][0]["count"] = 4000000000000ULL; }, "accessors[0]",
                     "needs 48000000000000 bytes for its 4000000000000 elements, but bufferView 0 has 36"},
        DocumentFlaw{"largest_count", [](Json& d) { d["accessors"][0]["count"] = 18446744073709551615ULL; },
                     "accessors[0].count", "a whole number"},
        DocumentFlaw{"zero_count", [](Json& d) { d["accessors"][0]["count"] = 0; }, "accessors[0].count",
                     "a whole number"},
        DocumentFlaw{"forged_zeros",
                     [](Json& d) { d["accessors"][0]["count"] = 4000000, d["accessors"][0].erase("bufferView"); },
                     "nodes", "GB of memory"},
        DocumentFlaw{"huge_zeros",
                     [](Json& d) { d["accessors"][0]["count"] = 4000000000ULL, d["accessors"][0].erase("bufferView"); },
                     "nodes", "GB of memory"},
        DocumentFlaw{"offset", [](Json& d) { d["accessors"][0]["byteOffset"] = 1; }, "accessors[0]", "needs 37 bytes"},
        DocumentFlaw{"view_offset", [](Json& d) { d["bufferViews"][0]["byteOffset"] = 9007199254740991ULL; },
                     "bufferViews[0]", "reaches from byte 9007199254740991"},
        DocumentFlaw{"stride", [](Json& d) { d["bufferViews"][0]["byteStride"] = 6; }, "accessors[0]",
                     "has elements of 12 bytes, but bufferView 0 has a stride of 6"},
        DocumentFlaw{"small_stride", [](Json& d) { d["bufferViews"][0]["byteStride"] = 4; }, "accessors[0]",
                     "has elements of 12 bytes, but bufferView 0 has a stride of 4"},
        DocumentFlaw{"component", [](Json& d) { d["accessors"][0]["componentType"] = 5124; },
                     "accessors[0].componentType", "one of 5120 5121 5122 5123 5125 5126"},
        DocumentFlaw{"type", [](Json& d) { d["accessors"][0]["type"] = "VEC7"; }, "accessors[0].type", "one of SCALAR"},
        DocumentFlaw{"wrong_type", [](Json& d) { d["accessors"][0]["type"] = "VEC2"; }, "accessors[0]",
                     "is of type VEC2, but an instance attribute"},
        DocumentFlaw{"not_normalised", [](Json& d) { d["accessors"][1]["normalized"] = false; }, "accessors[1]",
                     "needs floats (5126) or normalised bytes or shorts"},
        DocumentFlaw{"unequal", [](Json& d) { d["accessors"][1]["count"] = 2; },
                     "nodes[2].extensions.EXT_mesh_gpu_instancing.attributes.ROTATION",
                     "has 2 instances, but TRANSLATION has"},
        DocumentFlaw{"sparse_count",
                     [](Json& d) {
                         d["accessors"][0]["sparse"] = {{"count", 4},
                                                        {"indices", {{"bufferView", 0}, {"componentType", 5121}}},
                                                        {"values", {{"bufferView", 0}}}};
                     },
                     "accessors[0].sparse.count", "is 4, more than the accessor's 3 elements"},
        DocumentFlaw{"sparse_index",
                     [](Json& d) {
                         d["accessors"][0]["sparse"] = {{"count", 3},
                                                        {"indices", {{"bufferView", 0}, {"componentType", 5123}}},
                                                        {"values", {{"bufferView", 0}}}};
                     },
                     "accessors[0].sparse.indices", "entry 1 is 16256, but the accessor has 3 elements"},
        DocumentFlaw{"sparse_extent",
                     [](Json& d) {
                         d["accessors"][0]["sparse"] = {{"count", 3},
                                                        {"indices", {{"bufferView", 0}, {"componentType", 5125}}},
                                                        {"values", {{"bufferView", 0}, {"byteOffset", 4}}}};
                     },
                     "accessors[0].sparse.values", "needs 40 bytes"},
        DocumentFlaw{"short_buffer", [](Json& d) { d["buffers"][0]["byteLength"] = 3; }, "bufferViews[1]",
                     "but buffer 0 has 3 bytes"}),
    flaw_name);

class Malformed : public test::GltfFiles {
  protected:
    std::string error_of_bytes(const std::string& bytes) const { return error_of(write("scene.gltf", bytes)); }
};

TEST_F(Malformed, NumbersThatAreNotFinite) {
    TestFile file = rich_file();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    file.data.replace(4, 4, test::bytes_of(std::vector<float>{nan}));
    EXPECT_TRUE(contains(error_of(file), "accessors[0]: element 0 has a number that is not finite"));  // of instances
    std::string text = small_file().text();
    text.replace(text.find("0.8"), 3, "1e999");
    EXPECT_TRUE(contains(error_of_bytes(text), "is not well-formed JSON: number overflow"));
}

TEST_F(Malformed, ScenesThatAreNotValidNameTheNode) {
    TestFile file = small_file();
    file.json["nodes"][1]["scale"] = {1, 1e19, 1};
    EXPECT_TRUE(
        contains(error_of(file), "the scene is not valid: node 'ball' has a scale that is not finite or beyond"));
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
    EXPECT_TRUE(contains(error_of_bytes("[]"), "is not a JSON object"));
    EXPECT_TRUE(contains(error_of_bytes("{\"asset\": "), "is not well-formed JSON: parse error at line 1"));
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
    file.json["nodes"][many + 1]["scale"] = {1, 1, 1e30};
    file.json["nodes"][many]["scale"] = {1, 1, 1e30};
    EXPECT_TRUE(contains(error_of(file), "has a scale that is not finite or beyond 1e18; and 1 more"));
}

/// A few words of JSON must not become gigabytes.
TEST_F(Malformed, RepetitionIsBounded) {
    TestFile file = rich_file();
    Json& primitives = file.json["meshes"][1]["primitives"];
    for (int i = 0; i < 400; ++i) primitives.push_back(primitives[0]);
    const std::size_t places = file.add_floats("VEC3", std::vector<float>(90'000, 1));
    file.json["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", places}};
    EXPECT_TRUE(
        contains(error_of(file), "nodes: 2 of them show the equivalent of 48120004 faces, which takes 11.31 GB"));
    // primitives without faces are work as well
    file = rich_file();
    for (int i = 0; i < 3000; ++i) {
        file.json["meshes"][0]["primitives"].push_back({{"mode", 1}});
        file.json["nodes"].push_back({{"mesh", 0}});
        file.json["scenes"][0]["nodes"].push_back(i + 4);
    }
    EXPECT_TRUE(contains(error_of(file), "nodes: 3002 of them show the equivalent of 36024016 faces"));
}

}  // namespace
}  // namespace tandem
