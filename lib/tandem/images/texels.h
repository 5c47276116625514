/// Reads texture images from PNG and JPEG files.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tandem/base/whole_file.h"

namespace tandem {

/// 8 bits per channel, as in the file, ignoring gamma and colour profiles.
struct Texels {
    std::uint32_t width = 0, height = 0;
    /// Row by row from the top: red in the lowest 8 bits, then green, blue and alpha.
    std::vector<std::uint32_t> texels{};
};

/// Limit of the edges of decoded textures.
inline constexpr std::uint32_t most_texture_edge = 16384;

/// The size in the header of an image.
struct TexelSize {
    std::uint32_t width = 0, height = 0;
    std::size_t work = 0;  ///< of decoding, in pixels of a grey single-pass image
};

/// The limit of the work of decoding `bytes` bytes of files, so that a small file cannot take many seconds.
[[nodiscard]] constexpr std::size_t decoding_limit(std::size_t bytes) {
    constexpr std::size_t least = std::size_t{1} << 28, per_byte = 64;
    return bytes > least / per_byte ? per_byte * bytes : least;
}

/// The edge of an image whose squares of 2^shift x 2^shift pixels become texels.
[[nodiscard]] constexpr std::uint32_t shrunk_edge(std::uint32_t edge, unsigned shift) {
    return (edge + (1U << shift) - 1) >> shift;
}

/// The size of a PNG or JPEG, from its header. Throws as decode_texels() does.
[[nodiscard]] TexelSize texel_size(std::span<const std::byte> bytes, const std::string& name);

/// Decodes a PNG or JPEG, distinguished by the first bytes. Every PNG: grey and palettes become RGB, 16 bits become 8,
/// and without alpha the image is opaque. JPEG: grey and YCbCr, Huffman-coded, baseline or progressive.
///
/// `shift`, up to 12: each edge is divided by 2^shift, rounded up, and texels are means (texel_rows.h); for an
/// interlaced PNG they are the upper left pixels. That only takes memory for the smaller image.
///
/// Throws InputError with the image's `name` for other formats and for data that is malformed, cut off, larger than
/// 16384 x 16384, or of more pixels than its bytes can encode, before memory is allocated. The same goes for images
/// whose decoding is out of proportion to their bytes: beyond decoding_limit(), as for a JPEG with very many passes, or
/// with 256 MiB of coefficients of a JPEG in several passes, unless its file is large too. Throws EnvironmentError for
/// a JPEG in a build without libjpeg.
[[nodiscard]] Texels decode_texels(std::span<const std::byte> bytes, const std::string& name, unsigned shift = 0);

/// The same for a file.
[[nodiscard]] Texels read_texels(const std::string& path);

[[nodiscard]] TexelSize png_texel_size(std::span<const std::byte> bytes, const std::string& name);
[[nodiscard]] TexelSize jpeg_texel_size(std::span<const std::byte> bytes, const std::string& name);
[[nodiscard]] Texels decode_png_texels(std::span<const std::byte> bytes, const std::string& name, unsigned shift);
[[nodiscard]] Texels decode_jpeg_texels(std::span<const std::byte> bytes, const std::string& name, unsigned shift);

}  // namespace tandem
