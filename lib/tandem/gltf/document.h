/// The JSON document of a glTF file, and errors in it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tandem/gltf/flaws.h"

namespace tandem::gltf {

using Json = nlohmann::json;

inline constexpr const char* is_gltf_1 =
    "is glTF 1.0; Tandem reads glTF 2.0, so convert the file, for example with gltf-pipeline";

/// A file as read: JSON and, in a .glb, the binary chunk.
struct Document {
    Document() = default;
    Document(const Document&) = delete;  // `chunk` points into `bytes`
    Document& operator=(const Document&) = delete;
    Document(Document&&) = default;
    Document& operator=(Document&&) = default;
    ~Document() = default;

    std::filesystem::path file;
    Json json;
    std::vector<std::byte> bytes;                     ///< of a .glb with a binary chunk; else empty
    std::optional<std::span<const std::byte>> chunk;  ///< part of `bytes`

    /// Throws a Flaw, from which a caller may recover: "FILE: JSON_PATH: what".
    [[noreturn]] void fail(std::string_view json_path, std::string_view what) const;

    /// Refuses the file: throws an InputError, from which no caller recovers.
    [[noreturn]] void refuse(std::string_view json_path, std::string_view what) const;
    [[noreturn]] void refuse(const Flaw& flaw) const;  ///< with the root cause of a flaw

    /// Length of an array of the root object, by JSON pointer without the first slash: "nodes",
    /// "extensions/KHR_lights_punctual/lights". 0 if there is no such array.
    [[nodiscard]] std::size_t length(const std::string& array) const;
};

/// Reads a .gltf or .glb file, distinguished by the first bytes. Checks the container of a .glb, and that the JSON is a
/// well-formed object, nested no deeper than 64 levels. Throws InputError. Notes bytes after the end of a .glb, and
/// bytes that are not UTF-8.
[[nodiscard]] Document read_document(const std::filesystem::path& file, FlawLog& flaws);

/// The member of an object, or null.
[[nodiscard]] const Json* find(const Json& object, const char* member);

/// An extension of an object, or null.
[[nodiscard]] const Json* find_extension(const Json& object, const char* extension);

}  // namespace tandem::gltf
