/// Image files: PPM, PFM, PNG and EXR, chosen by the extension, with metadata in all of them (docs/images.md).
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tandem/images/image_codecs.h"

namespace tandem {

struct WriteOptions {
    bool ppm_text = false;  ///< .ppm files are P3 text instead of P6
    int png_level = 1;      ///< zlib's, 0 to 9; encode_png() has the measurement
    Durability durability = Durability::synced;
    Display display{};  ///< of PNG and PPM; PFM and EXR are linear
};

/// By the extension of a path: .ppm, .pfm, .png or .exr, in either case. Throws InputError that lists them, and
/// EnvironmentError for .exr in a build without OpenEXR.
[[nodiscard]] ImageFormat format_of(const std::string& path, const WriteOptions& options = {});

struct EncodedImage {
    Bytes bytes;
    std::size_t nan_values = 0;  ///< NaN that the tone curve made 0; float formats keep them
    std::vector<std::pair<FilmPlane, Bytes>> plane_files{};  ///< of a PFM, which holds one plane; an EXR holds all
};

/// Throws InputError, saying which formats do, if files of that format cannot hold the planes: those of 8 bits cannot.
void check_holds(ImageFormat format, PlaneMask planes);

/// Of a plane in a file of its own, beside the PFM of the colour: "a.normal.pfm" for "a.pfm".
[[nodiscard]] std::string plane_path(const std::string& path, FilmPlane plane);

/// What a file of that format says of a picture: with the size, and the display that the format takes part in.
[[nodiscard]] ImageMetadata as_written(ImageMetadata metadata, int width, int height, ImageFormat format,
                                       const WriteOptions& options);

/// The bytes of a file. The metadata are those of as_written(), whatever was given. PPM and PNG go through exposure and
/// transfer function of the display; PFM and EXR hold the floats, bit for bit.
[[nodiscard]] EncodedImage encode_image(const FloatImage& image, ImageFormat format, const ImageMetadata& metadata,
                                        const WriteOptions& options = {});
/// Of the means and the planes of the film, whose memory it lets go of before the slow part: a backend that owns the
/// memory can render the next frame into it meanwhile.
[[nodiscard]] EncodedImage encode_image(Film film, ImageFormat format, const ImageMetadata& metadata,
                                        const WriteOptions& options = {});
/// Puts encoded bytes at `path`, whole or not at all (write_file()), and planes in files of their own before that, so
/// that they are there when the picture is. The metadata of a PFM go to a file of the same name with ".txt" behind it,
/// which is bound to the image by its hash: it counts only beside the very bytes that it was written for.
void write_encoded(const std::string& path, const EncodedImage& encoded, ImageFormat format,
                   const ImageMetadata& metadata, const WriteOptions& options = {});

/// encode_image() and write_encoded(). Throws InputError for a path that cannot be, EnvironmentError where the machine
/// fails; both name the path and the reason.
void write_image(const std::string& path, const FloatImage& image, const ImageMetadata& metadata,
                 const WriteOptions& options = {});
/// The means of the film, whose memory it lets go of early, as encode_image() does.
void write_image(const std::string& path, Film film, const ImageMetadata& metadata, const WriteOptions& options = {});

/// The format is found out from the bytes, not from the extension. Throws InputError with the path and the reason if
/// the file cannot be read whole.
[[nodiscard]] DecodedImage read_image(const std::string& path);

/// What the file says about itself, or nothing. Reads the pixels too, so that a damaged file is an InputError.
[[nodiscard]] std::optional<ImageMetadata> read_metadata(const std::string& path);

}  // namespace tandem
