/// Resolves URIs of a glTF file: files beside it, and data URIs.
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
    bool is_lfs_pointer = false;  ///< the file is a Git LFS pointer (base/lfs_pointer.h)
};

/// The file that a relative URI names: a regular file within the folder of the glTF file, links resolved. Like other
/// viewers, treats '\' as '/', and keeps a '%' that is not followed by hexadecimal digits. Throws a Flaw with
/// `json_path`. Reads only the beginning of the file.
[[nodiscard]] LocatedFile locate_beside(const Document& document, const std::string& json_path, const std::string& uri);

/// The bytes of such a file; throws a Flaw with `json_path`.
[[nodiscard]] Bytes read_beside(const Document& document, const std::string& json_path,
                                const std::filesystem::path& file);

/// The base64 digits of a data URI, of any media type, without the padding; throws a Flaw if they are malformed.
[[nodiscard]] std::string_view base64_digits(const Document& document, const std::string& json_path,
                                             std::string_view uri);

/// The bytes of such digits.
[[nodiscard]] Bytes decode_base64(std::string_view digits);

}  // namespace tandem::gltf
