/// Pictures and metadata for the tests of image files.
#pragma once

#include <bit>
#include <cstring>
#include <limits>
#include <random>
#include <string_view>

#include "tandem/images/image_codecs.h"

namespace tandem::test {

inline constexpr Display sample_display{TransferFunction::srgb, -6.3};

/// Every field set, the numbers to their largest values.
inline ImageMetadata sample_metadata(int width, int height) {
    ImageMetadata metadata;
    metadata.film_sha256 = std::string(64, 'a');
    metadata.scene_hash = std::string(64, '5');
    metadata.frame = std::numeric_limits<std::uint32_t>::max();
    metadata.width = width;
    metadata.height = height;
    metadata.samples = 1 << 24;
    metadata.seed = std::numeric_limits<std::uint64_t>::max();
    metadata.tier = "strict";
    metadata.backend = "cpu";
    metadata.version = "1.2.3";
    metadata.transfer = to_string(sample_display.transfer);
    metadata.exposure_stops = sample_display.exposure_stops;
    metadata.exposure_rule = "auto";
    return metadata;
}

/// All 256 levels and more, with no two rows or columns alike.
inline ByteImage sample_bytes(int width, int height) {
    ByteImage image{width, height, {}};
    std::mt19937 random(7);
    image.values.resize(3 * pixel_count(image));
    for (std::size_t i = 0; i < image.values.size(); ++i) {
        image.values[i] = static_cast<std::uint8_t>(i < 256 ? i : random() % 256);
    }
    return image;
}

/// Every bit pattern may occur: NaN with payloads, infinities, subnormals, both zeros.
inline FloatImage sample_floats(int width, int height) {
    FloatImage image{width, height, {}};
    std::mt19937 random(11);
    const auto any = [&] { return std::bit_cast<float>(static_cast<std::uint32_t>(random())); };
    image.pixels.resize(pixel_count(image));
    for (Vec3f& pixel : image.pixels) {
        pixel.x = any();
        pixel.y = any();
        pixel.z = any();
    }
    const float special[] = {-0.0F,
                             0.0F,
                             std::bit_cast<float>(0x7F800001U),
                             std::bit_cast<float>(0xFFC12345U),
                             std::numeric_limits<float>::infinity(),
                             std::numeric_limits<float>::denorm_min()};
    for (std::size_t i = 0; i < std::size(special) && i < image.pixels.size(); ++i) image.pixels[i].y = special[i];
    return image;
}

inline bool same_bits(const FloatImage& a, const FloatImage& b) {
    return a.width == b.width && a.height == b.height && a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(Vec3f)) == 0;
}

inline std::string_view text_of(const Bytes& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline Bytes bytes_of(std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

}  // namespace tandem::test
