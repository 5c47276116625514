/// The 8-bit levels of sums of samples, written once for the host (images/tone_curve.h) and for GPUs. A transfer
/// function is applied in two steps: place() is arithmetic alone, so compilers vectorise loops over it; at() may look
/// into a table. In a single loop, the table would prevent vectorisation.
#pragma once

#include <array>
#include <cstdint>

#include "tandem/math/real.h"

namespace tandem {

/// The mean of a sum of samples, rounded to float; not by narrow(), which cannot be vectorised.
TANDEM_HD_INLINE float mean_of_sum(double sum, double samples) { return static_cast<float>(sum / samples); }

/// A value times exposure_factor(), rounded once.
TANDEM_HD_INLINE float exposed(float linear, double factor) {
    return static_cast<float>(static_cast<double>(linear) * factor);
}

/// Clamps to [0, 1]; a NaN gives 0.
TANDEM_HD_INLINE float clamp_to_unit(float linear) { return linear > 0 ? (linear < 1 ? linear : 1.0F) : 0.0F; }

/// 255 times the clamped value, rounded to the nearest. The product is exact in double, so there is one rounding.
struct LinearLevels {
    [[nodiscard]] TANDEM_HD_INLINE static std::uint32_t place(float linear) {
        const double with_half = static_cast<double>(clamp_to_unit(linear)) * 255.0 + 0.5;
        return static_cast<std::uint32_t>(static_cast<std::int32_t>(with_half));
    }
    [[nodiscard]] TANDEM_HD_INLINE static std::uint8_t at(std::uint32_t place) {
        return static_cast<std::uint8_t>(place);
    }
};

/// The levels of sRGB, from a table indexed by the upper half of a float's bits. Each entry covers at most one border
/// between levels and stores it: the least float of the upper level. So a level is exact if the borders are, which a
/// test checks with many digits.
struct SrgbLevels {
    /// From 2^-13 to 1, one for each 2^16 floats, so 128 for each power of two: 2^16 times the level of the first
    /// float, plus how many of the floats are not below the border. With the lower half of a place added, it carries
    /// into the next level from the border on.
    using Entries = std::array<std::uint32_t, 13 * 128 + 1>;
    static constexpr float least = 0x1p-13F;  ///< less than any border

    const std::uint32_t* entries;  ///< of srgb_level_entries(), or a copy

    /// The distance from `least`, in floats; a NaN becomes black.
    [[nodiscard]] TANDEM_HD_INLINE static std::uint32_t place(float linear) {
        const float positive = linear > least ? linear : least;
        const float clamped = positive < 1 ? positive : 1.0F;
        return bits_of(clamped) - bits_of(least);
    }
    [[nodiscard]] TANDEM_HD_INLINE std::uint8_t at(std::uint32_t place) const {
        return static_cast<std::uint8_t>((entries[place >> 16] + (place & 0xFFFF)) >> 16);
    }
};

}  // namespace tandem
