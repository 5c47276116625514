/// From linear radiance to 8 bits, and back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tandem/images/display.h"
#include "tandem/images/image.h"

namespace tandem {

/// [0, 1], by clamping; a NaN gives 0.
[[nodiscard]] inline float clamp_to_unit(float linear) { return linear > 0 ? (linear < 1 ? linear : 1.0F) : 0.0F; }

/// The level, from 0 to 255, that is nearest to 255 times the transfer function of the clamped value: correctly rounded
/// for every float. The borders between levels of sRGB are irrational or no floats; among those of `linear` one float
/// is a tie, 0.5 (127.5), and it goes up to 128. Infinities clamp; a NaN gives 0.
[[nodiscard]] std::uint8_t to_level(float linear, TransferFunction transfer);

struct ToneMapped {
    ByteImage image;
    std::size_t nan_values = 0;  ///< how many of the 3 * width * height values were NaN, and are 0 now
};

/// The levels of value times exposure_factor(), which is rounded once to float.
[[nodiscard]] ToneMapped tone_map(const FloatImage& image, const Display& display = {});
/// Of the means, as film_to_image() has them, without an image of floats in between.
[[nodiscard]] ToneMapped tone_map(const Film& film, const Display& display = {});

/// What the levels from 0 to `most` stand for, each rounded once to float before the exposure is taken out; `most` is
/// from 1 to 65535.
[[nodiscard]] std::vector<float> values_of_levels(std::uint32_t most, const Display& display);

/// The linear values that 8 bits stand for. tone_map() with the same display gives the same levels back.
[[nodiscard]] FloatImage to_float(const ByteImage& image, const Display& display);

}  // namespace tandem
