/// The variance of samples from their sums.
#pragma once

#include <limits>

namespace tandem {

/// The unbiased estimate of the variance of the mean of `samples` values, from their sum and the sum of their squares.
/// Rounding cannot make it negative. That of a single value is unknown, so it is infinite.
[[nodiscard]] inline double variance_of_mean(double sum, double squares, double samples) {
    if (samples < 2) return std::numeric_limits<double>::infinity();
    const double deviation = squares - sum * sum / samples;
    return deviation > 0 ? deviation / (samples - 1) / samples : 0;
}

}  // namespace tandem
