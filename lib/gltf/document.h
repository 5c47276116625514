/// The JSON of a glTF file, and how errors in it are said.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace tandem::gltf {

using Json = nlohmann::json;

/// A file as it was read: JSON and, in a .glb, the binary chunk.
struct Document {
    std::filesystem::path file;
    Json json;
    std::vector<std::byte> chunk;
    bool has_chunk = false;

    /// Throws InputError: "FILE: JSON_PATH: what".
    [[noreturn]] void fail(std::string_view json_path, std::string_view what) const;

    /// Length of an array of the root, by JSON pointer without the first slash: "nodes",
    /// "extensions/KHR_lights_punctual/lights". 0 if there is none.
    [[nodiscard]] std::size_t length(const std::string& array) const;
};

/// Reads a .gltf or .glb file, told apart by their first bytes. Checks the container of a .glb, and that the JSON is
/// an object, well-formed and not nested deeper than 64 levels. Throws InputError.
[[nodiscard]] Document read_document(const std::filesystem::path& file);

/// The member of an object, or null.
[[nodiscard]] const Json* find(const Json& object, const char* member);

/// An extension of an object, or null.
[[nodiscard]] const Json* find_extension(const Json& object, const char* extension);

}  // namespace tandem::gltf
