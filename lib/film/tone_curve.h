/// From linear radiance to 8 bits, as the paper does it: clamped to [0, 1], no gamma.
#pragma once

#include <cstddef>
#include <cstdint>

#include "tandem/film/image.h"

namespace tandem {

/// [0, 1], by clamping; a NaN gives 0.
[[nodiscard]] inline float clamp_to_unit(float linear) { return linear > 0 ? (linear < 1 ? linear : 1.0F) : 0.0F; }

/// 255 times the clamped value, rounded to the nearest level. The product is exact in double, so there is one rounding.
/// Among floats there is a single tie, 0.5 (127.5), and it goes up to 128. Infinities clamp; a NaN gives 0.
[[nodiscard]] inline std::uint8_t to_level(float linear) {
    return static_cast<std::uint8_t>(static_cast<int>(static_cast<double>(clamp_to_unit(linear)) * 255.0 + 0.5));
}

struct ToneMapped {
    ByteImage image;
    std::size_t nan_values = 0;  ///< how many of the 3 * width * height values were NaN, and are 0 now
};

[[nodiscard]] ToneMapped tone_map(const FloatImage& image);
/// Of the means, as film_to_image() has them, without an image of floats in between.
[[nodiscard]] ToneMapped tone_map(const Film& film);

}  // namespace tandem
