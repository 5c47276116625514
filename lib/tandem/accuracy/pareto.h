/// Which configurations are worth their time.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tandem/accuracy/error_estimate.h"

namespace tandem {

/// A configuration that was measured.
struct PricedError {
    double seconds = 0;
    Interval seconds_interval;
    ErrorEstimate error;
};

/// For every point another one that dominates it, or nothing. A point dominates another if neither its time nor its
/// error is larger, and the intervals of one of the two do not overlap: what the measurement cannot tell apart does not
/// dominate. Of several, the one with the least error is named, and of these the one with the least time.
[[nodiscard]] std::vector<std::optional<std::size_t>> dominating(std::span<const PricedError> points);

/// The point with the least error among those that take at most `seconds`; nothing if none does.
[[nodiscard]] std::optional<std::size_t> best_within(std::span<const PricedError> points, double seconds);

/// The fastest point whose error is at most `error`; nothing if none is.
[[nodiscard]] std::optional<std::size_t> fastest_within(std::span<const PricedError> points, double error);

}  // namespace tandem
