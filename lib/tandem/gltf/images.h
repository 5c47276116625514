/// The pictures of a glTF file.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "tandem/gltf/buffers.h"
#include "tandem/images/texels.h"
#include "tandem/scene/texture.h"

namespace tandem::gltf {

/// A PNG or JPEG before it is decoded.
struct EncodedImage {
    std::string json_path;             ///< of what leads to its bytes
    std::string name;                  ///< of those, for messages
    std::string place;                 ///< the same for images with the same bytes; empty for data URIs
    std::span<const std::byte> bytes;  ///< in a buffer or in `storage`
    Bytes storage{};
    TexelSize size{};  ///< as its header says
};

/// The bytes of image `index`: in a file beside the glTF file (uris.h), a data URI, or a buffer view. Throws a Flaw if
/// there are none, or their header is not one that can be read.
[[nodiscard]] EncodedImage read_image(const Source& source, std::size_t index);

/// `shift`: as for decode_texels(). Throws a Flaw.
[[nodiscard]] Image decode_image(const Source& source, std::size_t index, const EncodedImage& encoded, unsigned shift);

/// Halves the edges of an image. Texels become the means of four.
void halve(Image& image);

}  // namespace tandem::gltf
