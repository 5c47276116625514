/// Statistics of repeated timings: robust centre and spread, and confidence intervals of ratios.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tandem {

/// The middle value; for an even count the mean of the two middle ones. Needs at least one value.
[[nodiscard]] double median(std::span<const double> values);

/// The median of the distances to the median, not scaled: half of the values lie within it.
[[nodiscard]] double median_absolute_deviation(std::span<const double> values);

struct Interval {
    double low = 0;
    double high = 0;
};

/// An interval that contains the median of the distribution with at least 95 % probability, whatever the distribution:
/// two of the measurements, as far from both ends. Empty for fewer than six values, which are too few.
/// Source: H. A. David, H. N. Nagaraja, "Order Statistics", 3rd edition, 2003, section 7.1.
[[nodiscard]] std::optional<Interval> interval_of_median(std::span<const double> values);

/// A summary of repeated measurements of one thing. All zero if there are none.
struct Summary {
    std::size_t count = 0;
    double median = 0;
    double deviation = 0;  ///< median absolute deviation
    double least = 0;
    double most = 0;
    std::optional<Interval> interval{};  ///< interval_of_median()
};

[[nodiscard]] Summary summarize(std::span<const double> values);

/// A ratio of two medians.
struct Ratio {
    double value = 0;
    std::optional<Interval> interval;  ///< empty for fewer than three pairs, which are too few
    std::size_t pairs = 0;
};

struct BootstrapOptions {
    int resamples = 4000;
    double confidence = 0.95;
    std::uint32_t seed = 1;  ///< the same seed gives the same interval, on every machine
};

/// median(numerator) / median(denominator), with a percentile bootstrap interval. Value i of both was measured in the
/// same round, so whole rounds are resampled: disturbances of both (clocks, other load) do not widen the interval. With
/// fewer than about ten rounds it covers somewhat less than nominal. Sizes must be equal and not zero, values positive.
/// Source: B. Efron, R. Tibshirani, "An Introduction to the Bootstrap", 1993, ch. 13.
[[nodiscard]] Ratio ratio_of_medians(std::span<const double> numerator, std::span<const double> denominator,
                                     const BootstrapOptions& options = {});

/// The order in which a round measures `variants` things: first to last, in the next round last to first (A B, B A), so
/// that a drift of the machine affects all equally.
[[nodiscard]] std::vector<std::size_t> interleaved_order(std::size_t variants, std::size_t round);

}  // namespace tandem
