#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "tandem/images/decode_checks.h"
#include "tandem/images/image_codecs.h"
#include "tandem/images/portable_map.h"

namespace tandem {

static_assert(std::endian::native == std::endian::little, "PFM files are written in the byte order of memory");

Bytes encode_pfm(const FloatImage& image) {
    const std::string head = fmt::format("PF\n{} {}\n-1.0\n", image.width, image.height);
    const std::size_t row_pixels = static_cast<std::size_t>(image.width);
    const std::size_t row_bytes = row_pixels * sizeof(Vec3f);
    Bytes bytes(head.size() + row_bytes * static_cast<std::size_t>(image.height));
    std::memcpy(bytes.data(), head.data(), head.size());
    std::byte* at = bytes.data() + head.size();
    for (auto y = static_cast<std::size_t>(image.height); y-- > 0; at += row_bytes) {
        std::memcpy(at, &image.pixels[y * row_pixels], row_bytes);
    }
    return bytes;
}

DecodedImage decode_pfm(std::span<const std::byte> bytes, const std::string& name) {
    PortableMapHeader header(bytes, name, "PFM");
    const std::string_view magic = header.word();
    if (magic != "PF" && magic != "Pf") fail_decoding(name, "PFM", "it does not begin with PF or Pf");
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
