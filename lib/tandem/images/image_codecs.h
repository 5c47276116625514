/// Image files as bytes in memory: a pair of functions for each format. image_io.h selects the format and handles
/// files. Encoders write the metadata that they are given. Decoders throw InputError with the file's `name` and the
/// reason for data that is malformed or cut off; they allocate no more than the data can fill.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "tandem/base/whole_file.h"
#include "tandem/film/plane_image.h"
#include "tandem/images/image.h"
#include "tandem/images/image_metadata.h"

namespace tandem {

/// `hdr`, Radiance's format, is read-only.
enum class ImageFormat { ppm_text, ppm, pfm, png, exr, hdr };

/// Whether the format stores linear floats (PFM, EXR, HDR), without exposure and transfer function.
[[nodiscard]] constexpr bool holds_floats(ImageFormat format) {
    return format == ImageFormat::pfm || format == ImageFormat::exr || format == ImageFormat::hdr;
}

struct DecodedImage {
    FloatImage image;  ///< linear: the display of integer formats is inverted
    std::optional<ImageMetadata> metadata;
    ImageFormat format = ImageFormat::ppm;
    Display display{TransferFunction::linear};  ///< the display of the values, as far as the file states it
};

/// PPM "P3": decimal text, one pixel per line, as in the paper. Metadata are comments.
[[nodiscard]] Bytes encode_ppm_text(const ByteImageView& image, const ImageMetadata& metadata);
/// PPM "P6": three bytes per pixel. Metadata are comments.
[[nodiscard]] Bytes encode_ppm(const ByteImageView& image, const ImageMetadata& metadata);
/// P3 and P6 with a largest value of up to 65535. The display is that of the metadata; without metadata, value /
/// largest value is linear.
[[nodiscard]] DecodedImage decode_ppm(std::span<const std::byte> bytes, const std::string& name);

/// PFM "PF": float, little endian, rows from the bottom up. The format cannot hold metadata (image_io.h writes a file
/// beside the image).
[[nodiscard]] Bytes encode_pfm(const FloatImage& image);
/// The same for a plane: "PF" for three channels, "Pf" for one. Whole numbers become the nearest floats, which are
/// exact up to 2^24.
[[nodiscard]] Bytes encode_pfm(const PlaneImage& plane, int width, int height);
/// PF and Pf (one channel, copied to all three), either byte order; the magnitude of the scale is ignored.
[[nodiscard]] DecodedImage decode_pfm(std::span<const std::byte> bytes, const std::string& name);

/// 8-bit RGB PNG. Metadata are tEXt chunks; if their transfer function is sRGB, the file is tagged as such (the chunk
/// sRGB, and gAMA and cHRM for readers that do not know it), else it has no tag. `level` is zlib's, 0 to 9; level 1
/// is ISA-L's (fast_deflate.h) or, in a build without it, only finds runs. Pixels are predicted from their left
/// neighbour (filter "sub").
/// Measured with libpng 1.6.39 on one core of a shared AMD EPYC: three spheres in front of a gradient, 1000 x 900,
/// smooth and with noise of half a level (standard deviation); best of 15:
///   level 1, runs only        14 ms 125 kB    36 ms 677 kB    the default without ISA-L
///   level 1, zlib's matches   13 ms 115 kB    49 ms 851 kB
///   level 3                   17 ms  92 kB    91 ms 768 kB
///   level 6                   37 ms  64 kB   270 ms 684 kB
/// Choosing the filter row by row takes about 20 ms more and saves at most a sixth. ISA-L takes a seventh of the time
/// of runs only, for files of that size (docs/performance/program.md), and several threads may share it
/// (png_encoder.h).
[[nodiscard]] Bytes encode_png(const ByteImageView& image, const ImageMetadata& metadata, int level);
/// Every PNG; grey and palettes become RGB, alpha is dropped. The display is that of the metadata. Without metadata, a
/// file with the chunk sRGB is sRGB, and in any other value / largest value is linear, whatever its other tags say.
[[nodiscard]] DecodedImage decode_png(std::span<const std::byte> bytes, const std::string& name);

/// 32-bit float EXR, lossless: NaN payloads and signed zeros survive. Metadata are string attributes. Throws
/// EnvironmentError in a build without OpenEXR.
/// Compressed line by line, at zlib's level 1. CPU time with OpenEXR 3.1.5 on a shared AMD EPYC, the paper's scene at
/// 20 samples, 1000 x 900; best of 9: 127 ms and 5.7 MB; in blocks of 16 lines at level 4 (ZIP) 165 ms and 4.6 MB;
/// uncompressed 20 ms and 10.8 MB.
/// `planes` become more channels, named as in planes.def; integers are stored exactly (UINT).
[[nodiscard]] Bytes encode_exr(const FloatImage& image, const ImageMetadata& metadata,
                               std::span<const PlaneImage> planes = {});
/// Reads R, G, B of an EXR, or its only channel for all three, in the data window of the first part; throws as
/// encode_exr() does.
[[nodiscard]] DecodedImage decode_exr(std::span<const std::byte> bytes, const std::string& name);

/// Radiance's RGBE, .hdr: 8 bits per channel and a shared exponent; flat or run-length encoded, rows from the top or
/// from the bottom. The radiance is divided by the EXPOSURE of the header; other variables, such as PRIMARIES, are
/// ignored.
[[nodiscard]] DecodedImage decode_hdr(std::span<const std::byte> bytes, const std::string& name);

/// Throws EnvironmentError, which says what to install, if this build does not support EXR.
void check_exr_support();

}  // namespace tandem
