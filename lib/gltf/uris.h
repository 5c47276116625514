/// Where a URI of a glTF file leads: to a file beside it, or to bytes of its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "tandem/file/whole_file.h"
#include "tandem/gltf/document.h"

namespace tandem::gltf {

struct LocatedFile {
    std::filesystem::path path;
    std::uintmax_t bytes = 0;
};

/// The file that a relative URI names. It is a regular one and lies within the folder of the glTF file, also through
/// links. Throws InputError with `json_path`. Reads nothing.
[[nodiscard]] LocatedFile locate_beside(const Document& document, const std::string& json_path, const std::string& uri);

/// What stands behind the comma of a data URI in base64, without the padding; throws InputError if it is broken.
[[nodiscard]] std::string_view base64_digits(const Document& document, const std::string& json_path,
                                             std::string_view text);

/// The bytes of such digits.
[[nodiscard]] Bytes decode_base64(std::string_view digits);

}  // namespace tandem::gltf
