#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "tandem/film/plane_names.h"
#include "tandem/images/decode_checks.h"
#include "tandem/images/image_codecs.h"
#include "tandem/images/portable_map.h"

namespace tandem {

static_assert(std::endian::native == std::endian::little, "PFM files are written in the byte order of memory");

namespace {

/// `pixels`: `channels` floats each, row by row from the top left.
Bytes encode_rows(const void* pixels, std::size_t channels, int width, int height) {
    const std::string head = fmt::format("{}\n{} {}\n-1.0\n", channels == 3 ? "PF" : "Pf", width, height);
    const std::size_t row_bytes = static_cast<std::size_t>(width) * channels * sizeof(float);
    Bytes bytes(head.size() + row_bytes * static_cast<std::size_t>(height));
    std::memcpy(bytes.data(), head.data(), head.size());
    std::byte* at = bytes.data() + head.size();
    for (auto y = static_cast<std::size_t>(height); y-- > 0; at += row_bytes) {
        std::memcpy(at, static_cast<const std::byte*>(pixels) + y * row_bytes, row_bytes);
    }
    return bytes;
}

}  // namespace

Bytes encode_pfm(const FloatImage& image) { return encode_rows(image.pixels.data(), 3, image.width, image.height); }

Bytes encode_pfm(const PlaneImage& plane, int width, int height) {
    const std::size_t channels = info_of(plane.plane).channels.size();
    if (plane.numbers.empty()) return encode_rows(plane.values.data(), channels, width, height);
    std::vector<float> values;
    values.reserve(plane.numbers.size());
    for (const std::uint32_t number : plane.numbers) values.push_back(static_cast<float>(number));
    return encode_rows(values.data(), channels, width, height);
}

DecodedImage decode_pfm(std::span<const std::byte> bytes, const std::string& name) {
    PortableMapHeader header(bytes, name, "PFM");
    const std::string_view magic = header.word();
    if (magic != "PF" && magic != "Pf") fail_decoding(name, "PFM", "it does not start with PF or Pf");
    const auto width = header.number<std::uint32_t>("width");
    const auto height = header.number<std::uint32_t>("height");
    const auto scale = header.number<double>("scale");
    check_size(name, "PFM", width, height);
    if (scale == 0 || !std::isfinite(scale)) {
        fail_decoding(name, "PFM", "its scale is not a number below or above zero");
    }
    const std::string_view pixels = header.pixels();

    DecodedImage result;
    result.format = ImageFormat::pfm;
    result.metadata = header.metadata();
    result.image.width = static_cast<int>(width);
    result.image.height = static_cast<int>(height);
    const std::size_t channels = magic == "PF" ? 3 : 1;
    check_data(name, "PFM", pixels.size(), pixel_count(result.image) * channels * sizeof(float));
    result.image.pixels.resize(pixel_count(result.image));
    const char* at = pixels.data();
    const auto next = [&] {
        std::uint32_t bits = 0;
        std::memcpy(&bits, at, sizeof(bits));
        at += sizeof(bits);
        return std::bit_cast<float>(scale < 0 ? bits : __builtin_bswap32(bits));
    };
    for (std::size_t y = height; y-- > 0;) {
        for (std::size_t x = 0; x < width; ++x) {
            const float first = next();
            Vec3f& pixel = result.image.pixels[y * width + x];
            pixel = {first, first, first};
            if (channels == 3) {
                pixel.y = next();
                pixel.z = next();
            }
        }
    }
    return result;
}

}  // namespace tandem
