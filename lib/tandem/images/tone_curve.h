/// Converts linear radiance to 8 bits, and back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tandem/images/display.h"
#include "tandem/images/image.h"
#include "tandem/math/tone_levels.h"

namespace tandem {

/// The level, from 0 to 255, that is nearest to 255 times the transfer function of the clamped value: correctly rounded
/// for every float. No border between levels of sRGB is a float; for `linear` one float is a tie, 0.5 (127.5), and it
/// is rounded up to 128. Infinities are clamped; a NaN gives 0.
[[nodiscard]] std::uint8_t to_level(float linear, TransferFunction transfer);

/// The table of SrgbLevels, made by the first call.
[[nodiscard]] const SrgbLevels::Entries& srgb_level_entries();

struct ToneMapped {
    ByteImage image;
    std::size_t nan_values = 0;  ///< how many of the 3 * width * height values were NaN and became 0
};

/// The levels of each value times exposure_factor(), with the product rounded once to float.
[[nodiscard]] ToneMapped tone_map(const FloatImage& image, const Display& display = {});
/// The same for the means of a film, as from film_to_image(), but without an intermediate float image.
[[nodiscard]] ToneMapped tone_map(const Film& film, const Display& display = {});

/// The linear values of the levels from 0 to `most`, each rounded once to float before the exposure is inverted; `most`
/// is from 1 to 65535.
[[nodiscard]] std::vector<float> values_of_levels(std::uint32_t most, const Display& display);

/// The linear values of an 8-bit image. tone_map() with the same display returns the same levels.
[[nodiscard]] FloatImage to_float(const ByteImage& image, const Display& display);

}  // namespace tandem
