/// The buffers of a file: where their bytes may come from, and how many there must be.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tandem/base/whole_file.h"
#include "tandem/gltf/document.h"

namespace tandem::gltf {

/// A rule of check_schema(). The bytes may be in a file within the folder of the glTF file, links resolved; in a base64
/// data URI; or, for the first buffer only, in the chunk of a .glb. Reduces a byteLength to the available bytes. Throws
/// a Flaw. Reads no file.
void check_buffer(const Document& document, FlawLog& flaws, Json& buffer, const std::string& path);

/// A checked document and the bytes of its buffers.
struct Source {
    Document document;
    std::vector<Bytes> storage;  ///< bytes that are not in the document
    /// One per buffer, of its byteLength; empty for a buffer that is left out.
    std::vector<std::span<const std::byte>> buffers;
};

/// The bytes of all buffers; those that share a file count once.
[[nodiscard]] std::size_t data_bytes(const Source& source);

/// Reads the buffers. Files that several buffers name are read once. Needs check_schema(). Throws InputError.
[[nodiscard]] Source load_buffers(Document document);

}  // namespace tandem::gltf
