#include "tandem/images/image_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "tandem/base/error.h"
#include "tandem/base/sha256.h"
#include "tandem/film/plane_names.h"
#include "tandem/images/tone_curve.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

std::string hash_of(std::span<const std::byte> bytes) {
    Sha256 hash;
    hash.update(bytes.data(), bytes.size());
    return hash.hex();
}

std::string sidecar_path(const std::string& path) { return path + ".txt"; }

constexpr const char* bound_to = "file_sha256";

std::string sidecar_text(std::span<const std::byte> bytes, const ImageMetadata& metadata) {
    std::string text = fmt::format("{}: {}\n", bound_to, hash_of(bytes));
    for (const auto& [key, value] : to_text(metadata)) text += fmt::format("{}: {}\n", key, value);
    return text;
}

/// Empty if there is no sidecar, or if it belongs to other bytes.
std::optional<ImageMetadata> read_sidecar(const std::string& path, std::span<const std::byte> bytes) {
    const std::string sidecar = sidecar_path(path);
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(sidecar, ignored)) return std::nullopt;
    const Bytes content = read_file(sidecar);
    std::string_view rest(reinterpret_cast<const char*>(content.data()), content.size());
    MetadataText text;
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        if (auto entry = parse_metadata_line(rest.substr(0, end))) text.push_back(std::move(*entry));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    const auto is_binding = [](const auto& entry) { return entry.first == bound_to; };
    const auto binding = std::find_if(text.begin(), text.end(), is_binding);
    if (binding == text.end() || binding->second != hash_of(bytes)) return std::nullopt;
    return metadata_from_text(text);
}

EncodedImage encode_floats(const FloatImage& image, std::span<const PlaneImage> planes, ImageFormat format,
                           const ImageMetadata& metadata, const WriteOptions& options) {
    if (format == ImageFormat::exr) {
        return {encode_exr(image, as_written(metadata, image.width, image.height, format, options), planes)};
    }
    EncodedImage encoded{encode_pfm(image)};
    for (const PlaneImage& plane : planes) {
        encoded.plane_files.emplace_back(plane.plane, encode_pfm(plane, image.width, image.height));
    }
    return encoded;
}

EncodedImage encode_levels(const ToneMapped& mapped, ImageFormat format, const ImageMetadata& metadata,
                           const WriteOptions& options) {
    const ImageMetadata complete = as_written(metadata, mapped.image.width, mapped.image.height, format, options);
    if (format == ImageFormat::png) return {encode_png(mapped.image, complete, options.png_level), mapped.nan_values};
    const auto encode = format == ImageFormat::ppm_text ? encode_ppm_text : encode_ppm;
    return {encode(mapped.image, complete), mapped.nan_values};
}

/// Encodes and writes images and films alike; a film is passed on so that its memory can be released early.
template <class Picture>
void write_picture(const std::string& path, Picture&& picture, int width, int height, const ImageMetadata& metadata,
                   const WriteOptions& options) {
    const ImageFormat format = format_of(path, options);
    const ImageMetadata complete = as_written(metadata, width, height, format, options);
    const EncodedImage encoded = encode_image(std::forward<Picture>(picture), format, complete, options);
    write_encoded(path, encoded, format, complete, options);
}

bool begins_with(std::span<const std::byte> bytes, std::string_view magic) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return text.starts_with(magic);
}

DecodedImage decode(std::span<const std::byte> bytes, const std::string& path) {
    using Decoder = DecodedImage (*)(std::span<const std::byte>, const std::string&);
    static constexpr std::pair<std::string_view, Decoder> decoders[] = {
        {"P3", decode_ppm},          {"P6", decode_ppm},      {"PF", decode_pfm}, {"Pf", decode_pfm},
        {"\x89PNG\r\n", decode_png}, {"v/1\x01", decode_exr}, {"#?", decode_hdr}};
    for (const auto& [magic, decoder] : decoders) {
        if (begins_with(bytes, magic)) return decoder(bytes, path);
    }
    throw InputError(
        fmt::format("'{}' is not an image that Tandem reads: PPM (P3, P6), PFM, PNG, EXR or Radiance HDR", path));
}

}  // namespace

ImageFormat format_of(const std::string& path, const WriteOptions& options) {
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (extension == ".ppm") return options.ppm_text ? ImageFormat::ppm_text : ImageFormat::ppm;
    if (extension == ".pfm") return ImageFormat::pfm;
    if (extension == ".png") return ImageFormat::png;
    if (extension == ".exr") {
        check_exr_support();
        return ImageFormat::exr;
    }
    throw InputError(fmt::format("unknown image format of '{}': the name must end in .ppm, .pfm, .png or .exr", path));
}

void check_holds(ImageFormat format, PlaneMask planes) {
    if (planes.empty() || holds_floats(format)) return;
    throw InputError(
        fmt::format("PNG and PPM files hold only the colour, not the planes {}; write a .exr, with all of them in one "
                    "file, or a .pfm, with one file for each",
                    to_string(planes)));
}

std::string plane_path(const std::string& path, FilmPlane plane) {
    const std::filesystem::path file(path);
    std::filesystem::path own = file.stem();
    own += fmt::format(".{}{}", info_of(plane).name, file.extension().string());
    return (file.parent_path() / own).string();
}

ImageMetadata as_written(ImageMetadata metadata, int width, int height, ImageFormat format,
                         const WriteOptions& options) {
    metadata.width = width;
    metadata.height = height;
    if (!holds_floats(format)) return with_display(std::move(metadata), options.display);
    metadata.exposure_rule.clear();
    return with_display(std::move(metadata), {TransferFunction::linear});
}

EncodedImage encode_image(const FloatImage& image, ImageFormat format, const ImageMetadata& metadata,
                          const WriteOptions& options) {
    const DefaultFpEnvironment guard;
    if (holds_floats(format)) return encode_floats(image, {}, format, metadata, options);
    return encode_levels(tone_map(image, options.display), format, metadata, options);
}

EncodedImage encode_image(const FloatImage& image, const std::vector<PlaneImage>& planes, ImageFormat format,
                          const ImageMetadata& metadata, const WriteOptions& options) {
    const DefaultFpEnvironment guard;
    PlaneMask mask;
    for (const PlaneImage& plane : planes) mask |= plane.plane;
    check_holds(format, mask);
    ImageMetadata complete = metadata;
    complete.planes = to_string(mask);
    if (holds_floats(format)) return encode_floats(image, planes, format, complete, options);
    return encode_image(image, format, complete, options);
}

EncodedImage encode_image(Film film, ImageFormat format, const ImageMetadata& metadata, const WriteOptions& options) {
    const DefaultFpEnvironment guard;
    check_holds(format, film.plane_mask());
    if (holds_floats(format)) {
        const FloatImage image = film_to_image(film);
        const std::vector<PlaneImage> planes = plane_images(film);
        film = {};
        return encode_image(image, planes, format, metadata, options);
    }
    const ToneMapped mapped = tone_map(film, options.display);
    film = {};
    return encode_levels(mapped, format, metadata, options);
}

void write_encoded(const std::string& path, const EncodedImage& encoded, ImageFormat format,
                   const ImageMetadata& metadata, const WriteOptions& options) {
    const auto write = [&](const std::string& to, const Bytes& bytes) {
        write_file(to, bytes, options.durability);
        if (format == ImageFormat::pfm) {
            write_file(sidecar_path(to), sidecar_text(bytes, metadata), options.durability);
        }
    };
    for (const auto& [plane, bytes] : encoded.plane_files) write(plane_path(path, plane), bytes);
    write(path, encoded.bytes);
}

void write_image(const std::string& path, const FloatImage& image, const ImageMetadata& metadata,
                 const WriteOptions& options) {
    write_picture(path, image, image.width, image.height, metadata, options);
}

void write_image(const std::string& path, Film film, const ImageMetadata& metadata, const WriteOptions& options) {
    const int width = film.width(), height = film.height();
    ImageMetadata complete = metadata;
    complete.planes = to_string(film.plane_mask());
    write_picture(path, std::move(film), width, height, complete, options);
}

DecodedImage read_image(const std::string& path) {
    const DefaultFpEnvironment guard;
    const Bytes bytes = read_file(path);
    DecodedImage result = decode(bytes, path);
    if (result.format == ImageFormat::pfm && !result.metadata) result.metadata = read_sidecar(path, bytes);
    return result;
}

std::optional<ImageMetadata> read_metadata(const std::string& path) { return read_image(path).metadata; }

}  // namespace tandem
