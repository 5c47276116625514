#include <gtest/gtest.h>

#include "gltf/files.h"

namespace tandem {
namespace {

using test::contains;
using test::rich_file;
using test::TestFile;

/// The glTF file lies in folder_/inside; a buffer that would do lies in folder_.
class Uris : public test::GltfFiles {
  protected:
    Uris() { write("secret.bin", rich_file().data); }

    std::filesystem::path with_uri(const std::string& uri) const {
        TestFile file = rich_file();
        file.json["buffers"] = {{{"uri", uri}, {"byteLength", file.data.size()}}};
        return write("inside/scene.gltf", file.text());
    }
    /// The instances of the file need the buffer.
    void expect_refused(const std::string& uri, const std::string& reason) const {
        EXPECT_TRUE(contains(error_of(with_uri(uri)), "buffers[0].uri: " + reason)) << uri;
    }
};

TEST_F(Uris, LeadingOutOfTheFolder) {
    for (const char* uri : {"../secret.bin", "..%2Fsecret.bin", "%2e%2e/secret.bin", "./../secret.bin",
                            "data/../../secret.bin", "%2E%2E%2Fsecret.bin", ".."}) {
        expect_refused(uri, "leads out of the folder");
    }
    const std::string absolute = (folder_ / "secret.bin").string();
    expect_refused(absolute, "is an absolute path");
    expect_refused("%2F" + absolute.substr(1), "is an absolute path");
    expect_refused("..\\secret.bin", "leads out of the folder");
    expect_refused("\\secret.bin", "is an absolute path");
}

TEST_F(Uris, WithSchemes) {
    for (const char* uri : {"file:///etc/passwd", "http://localhost/secret.bin", "HTTPS://x/y", "c:/secret.bin"}) {
        expect_refused(uri, "has a scheme");
    }
}

TEST_F(Uris, Links) {
    std::filesystem::create_directories(folder_ / "inside");
    std::filesystem::create_symlink(folder_ / "secret.bin", folder_ / "inside/link.bin");
    std::filesystem::create_directory_symlink(folder_, folder_ / "inside/up");
    expect_refused("link.bin", "names 'link.bin', a link that leads out");
    expect_refused("up/secret.bin", "names 'up/secret.bin', a link that leads out");
    write("inside/real.bin", rich_file().data);
    std::filesystem::create_symlink("real.bin", folder_ / "inside/alias.bin");
    EXPECT_EQ(import_gltf(with_uri("alias.bin")).scene.nodes.size(), 4U);
}

TEST_F(Uris, ThatNameNothingToRead) {
    expect_refused("none.bin", "names 'none.bin', which does not exist");
    expect_refused("", "is empty");
    expect_refused(".", "'.' is not a regular file");
    expect_refused("a%zzb", "names 'a%zzb', which does not exist");
    expect_refused("a%2", "names 'a%2', which does not exist");
    expect_refused("scene%00.bin", "contains control characters");
    expect_refused("~/secret.bin", "names '~/secret.bin', which does not exist");  // no expansion
    expect_refused("$HOME", "names '$HOME', which does not exist");
}

TEST_F(Uris, ShortFiles) {
    write("inside/short.bin", "abc");
    const std::string sentence = "buffers[0].byteLength: is 108, but the file has 3 bytes; it may be truncated";
    EXPECT_TRUE(contains(error_of(with_uri("short.bin")),
                         "bufferViews[1]: reaches from byte 36 to byte 60, but buffer 0 has 3 bytes"));
    TestFile file = rich_file();
    file.json["buffers"] = {{{"uri", "short.bin"}, {"byteLength", file.data.size()}}};
    file.json["nodes"][2].erase("extensions");  // the instances, which need the bytes
    EXPECT_TRUE(contains(test::sentences(import_gltf(write("inside/scene.gltf", file.text())).report), sentence));
    TestFile mesh = test::mesh_file();
    mesh.json["buffers"] = {{{"uri", "short.bin"}, {"byteLength", mesh.data.size()}}};
    EXPECT_TRUE(
        contains(error_of(write("inside/scene.gltf", mesh.text())), "but the file has 3 bytes; it may be truncated"));
    write("inside/short.bin", "");
    EXPECT_TRUE(contains(error_of(with_uri("short.bin")), "but the file has 0 bytes; it may be truncated"));
}

TEST_F(Uris, DataUris) {
    const std::string good = "data:application/octet-stream;base64," + test::base64(rich_file().data);
    EXPECT_EQ(import_gltf(with_uri(good)).scene.nodes.size(), 4U);
    const std::string digits = good.substr(good.find(',') + 1);
    for (const char* header : {"data:application/gltf-buffer;base64,", "data:;base64,", "data:text/plain;base64,"}) {
        EXPECT_EQ(import_gltf(with_uri(header + digits)).scene.nodes.size(), 4U) << header;
    }
    expect_refused("data:text/html,hello", "is a data URI that does not start with");
    expect_refused("data:", "is a data URI that does not start with");
    expect_refused("data:;base64,A", "is a data URI whose base64 is broken");
    expect_refused("data:;base64,AA=A", "is a data URI whose base64 is broken");
    std::string odd = good;
    odd[odd.size() - 10] = '*';
    expect_refused(odd, "is a data URI whose base64 is broken");
    EXPECT_TRUE(contains(test::sentences(import_gltf(with_uri(good.substr(0, good.size() - 4))).report),
                         "but its data URI has"));
    EXPECT_EQ(import_gltf(with_uri(good + "AAAA")).scene.nodes.size(), 4U);
}

}  // namespace
}  // namespace tandem
