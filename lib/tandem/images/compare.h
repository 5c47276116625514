/// Compares two films.
#pragma once

#include <array>
#include <cstddef>

#include "tandem/film/film.h"

namespace tandem {

/// When a pixel counts as differing; tolerances.def defines each. A NaN and a number differ at every tolerance, two NaN
/// only in their bits.
enum class Tolerance {
#define TANDEM_TOLERANCE(name, words) name,
#include "tandem/images/tolerances.def"
#undef TANDEM_TOLERANCE
};

inline constexpr std::array tolerances = {
#define TANDEM_TOLERANCE(name, words) Tolerance::name,
#include "tandem/images/tolerances.def"
#undef TANDEM_TOLERANCE
};

/// In words, for tables.
[[nodiscard]] const char* to_string(Tolerance tolerance);

struct FilmDifference {
    std::size_t pixels = 0;
    std::size_t differing_sums = 0;  ///< pixels whose sums differ in a bit, as in film_hash()
    std::array<std::size_t, tolerances.size()> differing_means{};  ///< pixels, by Tolerance
    double largest = 0;  ///< largest absolute difference of the means over all channels; infinite if only one is a NaN
    double mean = 0;     ///< mean absolute difference over all channels
    double rms = 0;      ///< root mean square of the differences

    /// The paper's residual rate at one tolerance: the share of differing pixels, from 0 to 1.
    [[nodiscard]] double residual_rate(Tolerance tolerance) const {
        return static_cast<double>(differing_means[static_cast<std::size_t>(tolerance)]) / static_cast<double>(pixels);
    }
};

/// The films may differ in samples (then the sums do). Throws InputError if their sizes differ or are zero.
[[nodiscard]] FilmDifference compare(const Film& a, const Film& b);

}  // namespace tandem
