/// The images of a glTF file.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "tandem/gltf/buffers.h"
#include "tandem/images/texels.h"
#include "tandem/scene/texture.h"

namespace tandem::gltf {

/// An encoded PNG or JPEG.
struct EncodedImage {
    std::string json_path;             ///< of the property that names its bytes
    std::string name;                  ///< of the bytes, for messages
    std::string place;                 ///< equal for images with the same bytes; empty for data URIs
    std::span<const std::byte> bytes;  ///< in a buffer or in `storage`
    Bytes storage{};
    TexelSize size{};  ///< from its header
};

/// The bytes of image `index`: from a file beside the glTF file (uris.h), a data URI, or a buffer view. Throws a Flaw
/// if there are none, or if their header cannot be read.
[[nodiscard]] EncodedImage read_image(const Source& source, std::size_t index);

/// `shift`: as for decode_texels(). Throws a Flaw.
[[nodiscard]] Image decode_image(const Source& source, std::size_t index, const EncodedImage& encoded, unsigned shift);

/// Halves the edges of an image. Each texel becomes the mean of four.
void halve(Image& image);

}  // namespace tandem::gltf
