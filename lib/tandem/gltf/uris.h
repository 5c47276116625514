/// Where a URI of a glTF file leads: to a file beside it, or to bytes of its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "tandem/base/whole_file.h"
#include "tandem/gltf/document.h"

namespace tandem::gltf {

struct LocatedFile {
    std::filesystem::path path;
    std::uintmax_t bytes = 0;
    std::string name;             ///< for messages
    bool is_lfs_pointer = false;  ///< a pointer of Git LFS in its place (base/lfs_pointer.h)
};

/// The file that a relative URI names. It is a regular one and lies within the folder of the glTF file, also through
/// links. As other viewers do, takes '\' for '/', and '%' for itself where no hexadecimal digits follow. Throws a Flaw
/// with `json_path`. Reads no more than the beginning of it.
[[nodiscard]] LocatedFile locate_beside(const Document& document, const std::string& json_path, const std::string& uri);

/// The bytes of such a file; throws a Flaw with `json_path`.
[[nodiscard]] Bytes read_beside(const Document& document, const std::string& json_path,
                                const std::filesystem::path& file);

/// What stands behind the comma of a data URI in base64, of any media type, without the padding; throws a Flaw if that
/// is broken.
[[nodiscard]] std::string_view base64_digits(const Document& document, const std::string& json_path,
                                             std::string_view uri);

/// The bytes of such digits.
[[nodiscard]] Bytes decode_base64(std::string_view digits);

}  // namespace tandem::gltf
