// What a file is before its JSON is looked at: .glb or text, its edition, its encoding.
#include <gtest/gtest.h>

#include <cstring>

#include "gltf/files.h"
#include "tandem/base/lfs_pointer.h"
#include "tandem/gltf/document.h"

namespace tandem {
namespace {

using gltf::is_gltf_1;
using test::contains;
using test::Json;
using test::rich_file;
using test::sentences;
using test::small_file;
using test::TestFile;

class Containers : public test::GltfFiles {
  protected:
    std::string error_of_bytes(const std::string& bytes) const { return error_of(write("scene.gltf", bytes)); }
};

TEST_F(Containers, ContainersOfGlb) {
    const auto changed = [&](std::size_t at, std::uint32_t word) {
        std::string bytes = rich_file().glb();
        bytes.replace(at, 4, test::bytes_of(std::vector<std::uint32_t>{word}));
        return error_of_bytes(bytes);
    };
    const std::size_t bytes = rich_file().glb().size();
    EXPECT_EQ(changed(4, 1), is_gltf_1);
    EXPECT_EQ(changed(4, 7), "is a .glb file of version 7; Tandem reads version 2");
    EXPECT_TRUE(
        contains(changed(8, 13), "has a length of 13 bytes in its header, less than any .glb file; the header is"));
    EXPECT_TRUE(contains(changed(8, static_cast<std::uint32_t>(bytes) + 9), ": 9 are missing; it may be truncated"));
    EXPECT_TRUE(contains(changed(12, 0xFFFFFFFF), "has a first chunk with a length of 4294967295 bytes"));
    EXPECT_TRUE(contains(changed(12, 4), "may be truncated"));
    EXPECT_TRUE(contains(changed(16, 0x004E4942), "whose first chunk is not JSON"));
    EXPECT_TRUE(contains(error_of_bytes("glTF"), "is too short for a .glb file: it has 4 of at least 8 bytes"));
}

TEST_F(Containers, BytesBehindTheEndOfAGlbAreNoted) {
    const auto noted = [&](const std::string& bytes) {
        return sentences(import_gltf(write("scene.glb", bytes)).report);
    };
    const std::string good = rich_file().glb();
    EXPECT_TRUE(
        contains(noted(good + "12345"),
                 "ignored: bytes behind the end of the .glb at header: 5 bytes follow the end that the header"));
    std::string longer = good + "123";
    longer.replace(8, 4, test::bytes_of(std::vector<std::uint32_t>{static_cast<std::uint32_t>(longer.size())}));
    EXPECT_TRUE(contains(noted(longer), "at header: 3 bytes follow the last chunk"));
    EXPECT_EQ(noted(good).find("header"), std::string::npos);
}

/// Buffers in the binary chunk of a .glb. What needs missing bytes is not rendered.
TEST_F(Containers, BuffersWithoutBytes) {
    TestFile file = test::mesh_file();
    file.json["buffers"] = {{{"byteLength", file.data.size() + 5}}};
    const auto glb = [&](const std::string& chunk) {
        return write("scene.glb", test::make_glb(file.json.dump(), chunk));
    };
    EXPECT_TRUE(contains(sentences(import_gltf(glb(file.data)).report), "at buffers[0].byteLength: is"));
    EXPECT_TRUE(contains(error_of(glb("")), "buffers[0].uri: is absent, and the file has no binary chunk"));
    file.json["buffers"] = {{{"byteLength", file.data.size()}}, {{"byteLength", 4}}};
    const ImportResult unused = import_gltf(glb(file.data));
    EXPECT_EQ(unused.scene.nodes[1].geometry.size(), 1U);
    EXPECT_TRUE(
        contains(sentences(unused.report), "ignored: buffer at buffers[1].uri: is absent; only the first buffer"));
    // one of two primitives is in the buffer that is not there
    file.json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 4}});
    file.json["accessors"].push_back({{"bufferView", 2}, {"componentType", 5121}, {"count", 3}, {"type", "SCALAR"}});
    Json second = file.json["meshes"][0]["primitives"][0];
    second["indices"] = 2;
    file.json["meshes"][0]["primitives"].push_back(second);
    const ImportResult half = import_gltf(glb(file.data));
    EXPECT_EQ(half.scene.nodes[1].geometry.size(), 1U);
    EXPECT_TRUE(contains(sentences(half.report),
                         "ignored: primitive at meshes[0].primitives[1].indices: names accessors[2], which is left out "
                         "(buffers[1].uri: is absent"));
    file.json["meshes"][0]["primitives"].erase(0);
    EXPECT_TRUE(contains(error_of(glb(file.data)), "buffers[1].uri: is absent"));
}

/// "is glTF 1.0" goes before whatever else is wrong with it as glTF 2.0.
TEST_F(Containers, OtherEditions) {
    EXPECT_EQ(error_of_bytes(R"({"asset": {"version": "1.0"}, "meshes": {"a": {}}, "scene": "s"})"), is_gltf_1);
    EXPECT_EQ(error_of_bytes(R"({"asset": {"version": 1}, "nodes": {}})"), is_gltf_1);
    EXPECT_EQ(error_of_bytes(R"({"asset": {}, "meshes": {"a": {}}})"), is_gltf_1);
    EXPECT_TRUE(
        contains(error_of_bytes(R"({"asset": {"version": "3.0"}})"), "asset.version: is '3.0'; Tandem reads glTF 2.0"));
    TestFile file = small_file();
    file.json["asset"]["version"] = "2";
    EXPECT_EQ(import(file).scene.nodes.size(), 2U);
}

/// What a clone has until the large files are fetched.
TEST_F(Containers, PointersOfGitLfs) {
    const std::string pointer =
        "version https://git-lfs.github.com/spec/v1\noid "
        "sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 12345\n";
    EXPECT_EQ(error_of_bytes(pointer), lfs_advice);
    TestFile file = test::mesh_file();
    file.json["buffers"] = {{{"uri", "mesh.bin"}, {"byteLength", file.data.size()}}};
    write("mesh.bin", pointer);
    EXPECT_EQ(error_of(file), std::string("buffers[0].uri: names 'mesh.bin', which ") + lfs_advice);
}

TEST_F(Containers, TextThatIsNotUtf8) {
    std::string text = small_file().text();
    text.replace(text.find("ball"), 4, "b\xE4ll");  // Latin 1
    const ImportResult result = import_gltf(write("scene.gltf", text));
    EXPECT_EQ(result.scene.nodes[1].name, "b?ll");
    EXPECT_TRUE(contains(sentences(result.report), "approximated: text that is not UTF-8 at root: "));
    text.replace(text.find("b\xE4ll"), 4, "b\xC3\xA4\xF0\x9F\x8E\xB1");
    EXPECT_EQ(import_gltf(write("scene.gltf", text)).scene.nodes[1].name, "b\xC3\xA4\xF0\x9F\x8E\xB1");
    for (const char* bad : {"\xC0\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\x80", "\xE2\x82"}) {  // RFC 3629
        std::string broken = small_file().text();
        broken.replace(broken.find("ball"), 4, bad);
        EXPECT_EQ(import_gltf(write("scene.gltf", broken)).scene.nodes[1].name, std::string(std::strlen(bad), '?'));
    }
}

}  // namespace
}  // namespace tandem
