/// Which configurations are not dominated by others.
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
/// error is larger, and the intervals of one of the two do not overlap: points that the measurement cannot tell apart
/// do not dominate each other. Of several, the one with the least error is named, and of these the one with the least
/// time.
[[nodiscard]] std::vector<std::optional<std::size_t>> dominating(std::span<const PricedError> points);

/// The fastest of those points within `seconds` whose error cannot be told from the least one there; nothing if none
/// takes as little.
[[nodiscard]] std::optional<std::size_t> best_within(std::span<const PricedError> points, double seconds);

/// The fastest point whose error is at most `error`, or cannot be told from it; nothing if none is.
[[nodiscard]] std::optional<std::size_t> fastest_within(std::span<const PricedError> points,
                                                        const ErrorEstimate& error);

}  // namespace tandem
