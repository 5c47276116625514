/// The bytes of a file's buffers: where they may come from, and how many there must be.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tandem/base/whole_file.h"
#include "tandem/gltf/document.h"

namespace tandem::gltf {

/// A rule of check_schema(). The bytes are in a file that lies within the folder of the glTF file, also through links;
/// in a data URI in base64; or in the chunk of a .glb, for the first buffer only. Shortens a byteLength to what is
/// there. Throws a Flaw. Reads no file.
void check_buffer(const Document& document, FlawLog& flaws, Json& buffer, const std::string& path);

/// A checked document and the bytes of its buffers.
struct Source {
    Document document;
    std::vector<Bytes> storage;  ///< of what is not in the document
    /// One per buffer, as long as its byteLength; empty for one that is left out.
    std::vector<std::span<const std::byte>> buffers;
};

/// Of all buffers; those that share a file count once.
[[nodiscard]] std::size_t data_bytes(const Source& source);

/// Reads the buffers. Files that several buffers name are read once. Needs check_schema(). Throws InputError.
[[nodiscard]] Source load_buffers(Document document);

}  // namespace tandem::gltf
