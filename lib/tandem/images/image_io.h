/// Reads and writes image files: PPM, PFM, PNG and EXR, selected by the extension, with metadata (docs/images.md).
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tandem/images/image_codecs.h"

namespace tandem {

struct WriteOptions {
    bool ppm_text = false;  ///< .ppm files are P3 text instead of P6
    int png_level = 1;      ///< 0 to 9, as of encode_png(), which has measurements
    Durability durability = Durability::synced;
    Display display{};  ///< of PNG and PPM; PFM and EXR are linear
};

/// The format by the extension of a path: .ppm, .pfm, .png or .exr, in either case. Throws InputError that lists them,
/// and EnvironmentError for .exr in a build without OpenEXR.
[[nodiscard]] ImageFormat format_of(const std::string& path, const WriteOptions& options = {});

struct EncodedImage {
    Bytes bytes;
    std::size_t nan_values = 0;                              ///< NaN that became 0; float formats keep them
    std::vector<std::pair<FilmPlane, Bytes>> plane_files{};  ///< for PFM, which holds one plane per file
};

/// Throws InputError if files of that format cannot hold the planes, as 8-bit formats cannot; names formats that can.
void check_holds(ImageFormat format, PlaneMask planes);

/// The path of a plane's own file, beside the PFM of the colour: "a.normal.pfm" for "a.pfm".
[[nodiscard]] std::string plane_path(const std::string& path, FilmPlane plane);

/// The metadata as a file of that format states them: with the size, and with the display if the format uses it.
[[nodiscard]] ImageMetadata as_written(ImageMetadata metadata, int width, int height, ImageFormat format,
                                       const WriteOptions& options);

/// Encodes a file, with the metadata of as_written(). PPM and PNG use exposure and transfer function of the display;
/// PFM and EXR hold the floats, bit for bit.
[[nodiscard]] EncodedImage encode_image(const FloatImage& image, ImageFormat format, const ImageMetadata& metadata,
                                        const WriteOptions& options = {});
/// The same with planes beside the colour, which the metadata name.
[[nodiscard]] EncodedImage encode_image(const FloatImage& image, const std::vector<PlaneImage>& planes,
                                        ImageFormat format, const ImageMetadata& metadata,
                                        const WriteOptions& options = {});
/// Encodes the means and the planes of the film, and releases its memory before the slow part, so that a backend that
/// owns the memory can render the next frame meanwhile.
[[nodiscard]] EncodedImage encode_image(Film film, ImageFormat format, const ImageMetadata& metadata,
                                        const WriteOptions& options = {});
/// Writes encoded bytes to `path`, whole or not at all (write_file()). Plane files are written first, so that they
/// exist when the image does. The metadata of a PFM go to a sidecar, a file of the same name with ".txt" appended. It
/// contains the hash of the image and is ignored beside any other bytes.
void write_encoded(const std::string& path, const EncodedImage& encoded, ImageFormat format,
                   const ImageMetadata& metadata, const WriteOptions& options = {});

/// encode_image() and write_encoded(). Throws InputError for an invalid path, EnvironmentError if the machine fails;
/// both name the path and the reason.
void write_image(const std::string& path, const FloatImage& image, const ImageMetadata& metadata,
                 const WriteOptions& options = {});
/// Writes the means of the film, and releases its memory early, as encode_image() does.
void write_image(const std::string& path, Film film, const ImageMetadata& metadata, const WriteOptions& options = {});

/// Reads an image whose format is detected from the bytes, not from the extension. Throws InputError with the path and
/// the reason if the file cannot be read whole.
[[nodiscard]] DecodedImage read_image(const std::string& path);

/// The metadata of a file, if it has any. Reads the pixels too, so that a damaged file is an InputError.
[[nodiscard]] std::optional<ImageMetadata> read_metadata(const std::string& path);

}  // namespace tandem
