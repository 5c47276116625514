/// Pictures for textures, out of PNG and JPEG files.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tandem/file/whole_file.h"

namespace tandem {

/// 8 bits a channel, as the file has them, without regard to gamma or colour profiles.
struct Texels {
    std::uint32_t width = 0, height = 0;
    /// Row by row from the top: red in the lowest 8 bits, then green, blue and alpha.
    std::vector<std::uint32_t> texels{};
};

/// Edges of textures that are decoded.
inline constexpr std::uint32_t most_texture_edge = 16384;

/// PNG or JPEG, told apart by their first bytes. Every PNG: grey and palettes become RGB, 16 bits 8, and what has no
/// alpha is opaque. JPEG: grey and YCbCr, Huffman-coded, baseline or progressive.
///
/// Throws InputError, which names the picture `name`, for other formats and for data that is malformed, cut off, larger
/// than 16384 x 16384, or of more pixels than its bytes can stand for; that is found out before memory is allocated.
/// EnvironmentError for a JPEG in a build without libjpeg.
[[nodiscard]] Texels decode_texels(std::span<const std::byte> bytes, const std::string& name);

/// The same of a file.
[[nodiscard]] Texels read_texels(const std::string& path);

[[nodiscard]] Texels decode_png_texels(std::span<const std::byte> bytes, const std::string& name);
[[nodiscard]] Texels decode_jpeg_texels(std::span<const std::byte> bytes, const std::string& name);

}  // namespace tandem
