/// The bytes of a file's buffers: where they may come from, and how many there must be.
#pragma once

#include <vector>

#include "tandem/gltf/document.h"

namespace tandem::gltf {

/// Where the bytes of a buffer are.
struct BufferSource {
    enum class Place { chunk, data_uri, file };

    Place place = Place::data_uri;
    std::filesystem::path file;  ///< for Place::file
    std::size_t bytes = 0;       ///< byteLength
};

/// One per buffer, checked: a relative path that stays within the folder of the glTF file, also through links; a
/// data URI in base64; the chunk of a .glb for the first buffer only; and as many bytes there as byteLength says.
/// Needs check_schema(). Throws InputError with the JSON path. Reads no file.
[[nodiscard]] std::vector<BufferSource> locate_buffers(const Document& document);

}  // namespace tandem::gltf
