/// glTF files that tests write.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/base64.h"
#include "support/input_error.h"
#include "tandem/gltf/import.h"

namespace tandem::test {

using Json = nlohmann::json;

/// A document and the bytes of its one buffer.
struct TestFile {
    Json json;
    std::string data;

    /// Appends numbers to the buffer, with a view and an accessor of floats; returns the accessor's index.
    std::size_t add_floats(const std::string& type, const std::vector<float>& values);
    /// The same for components of any type, which are normalised if they are integers.
    std::size_t add_bytes(const std::string& type, int component_type, std::size_t count, const std::string& bytes);
    /// Indices of a mesh as components of 5121, 5123 or 5125.
    std::size_t add_indices(int component_type, const std::vector<std::uint32_t>& values);

    /// As .gltf, with the buffer, if there are bytes, as a data URI.
    [[nodiscard]] std::string text() const;
    /// As .glb, with the buffer as the binary chunk.
    [[nodiscard]] std::string glb() const;
};

/// A camera "eye", a sphere "ball" of radius 1 with a Phong material, in one scene.
[[nodiscard]] TestFile small_file();

/// small_file() with a point light, an environment, a node "crowd" of three instances of a box, and an animation of
/// ball and crowd.
[[nodiscard]] TestFile rich_file();

/// A camera "eye" and a node "sheet" with a mesh of six vertices and two triangles.
[[nodiscard]] TestFile mesh_file();

/// mesh_file() with texture 0, a picture of two colours that no material shows yet.
[[nodiscard]] TestFile pictured_mesh_file();

/// A .glb of a JSON text and a binary chunk; none if it is empty.
[[nodiscard]] std::string make_glb(std::string json, std::string chunk);

/// The bytes of numbers, little endian.
template <class Number>
[[nodiscard]] std::string bytes_of(const std::vector<Number>& numbers) {
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

[[nodiscard]] std::string read_bytes(const std::filesystem::path& file);

/// The sentences of a report, one a line.
[[nodiscard]] std::string sentences(const ImportReport& report);

/// Tests that write files: each gets an empty folder that goes when it ends.
class GltfFiles : public testing::Test {
  protected:
    GltfFiles();
    ~GltfFiles() override;
    GltfFiles(const GltfFiles&) = delete;
    GltfFiles& operator=(const GltfFiles&) = delete;

    std::filesystem::path write(const std::string& name, const std::string& bytes) const;
    ImportResult import(const TestFile& file) const { return import_gltf(write("scene.gltf", file.text())); }

    /// The error of an import, less the name of the file, which must lead it; one line.
    std::string error_of(const std::filesystem::path& file) const;
    std::string error_of(const TestFile& file) const { return error_of(write("scene.gltf", file.text())); }

    std::filesystem::path folder_;
};

}  // namespace tandem::test
