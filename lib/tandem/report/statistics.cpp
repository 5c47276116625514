#include "tandem/report/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "tandem/kernel/sampler/philox.h"

namespace tandem {

namespace {

/// Reorders `values`.
double median_in_place(std::vector<double>& values) {
    assert(!values.empty());
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return (*std::max_element(values.begin(), middle) + *middle) / 2;
}

/// Uniform index below `count`, from draw number `draw` of resample number `resample`.
std::size_t drawn_index(std::uint32_t seed, std::uint32_t resample, std::uint32_t draw, std::size_t count) {
    const auto block = philox4x32<std::uint32_t>({{resample, draw, 0, 0}}, seed, 0xB0075);
    return static_cast<std::size_t>((std::uint64_t{block.word[0]} * count) >> 32);
}

/// The quantile `share` of `sorted`, interpolated linearly.
double quantile(const std::vector<double>& sorted, double share) {
    const double place = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    const double weight = place - static_cast<double>(below);
    return sorted[below] + (sorted[above] - sorted[below]) * weight;
}

}  // namespace

double median(std::span<const double> values) {
    std::vector<double> copy(values.begin(), values.end());
    return median_in_place(copy);
}

double median_absolute_deviation(std::span<const double> values) {
    const double centre = median(values);
    std::vector<double> distances;
    distances.reserve(values.size());
    for (const double value : values) distances.push_back(std::abs(value - centre));
    return median_in_place(distances);
}

std::optional<Interval> interval_of_median(std::span<const double> values) {
    const std::size_t count = values.size();
    // The k-th value from either end: the chance of fewer than k values beyond the median is at most 2.5 %
    double chance = std::exp2(-static_cast<double>(count));  // of exactly `below` values on one side
    double total = 0;
    std::size_t below = 0;
    while (below < count / 2 && total + chance <= 0.025) {
        total += chance;
        chance *= static_cast<double>(count - below) / static_cast<double>(below + 1);
        ++below;
    }
    if (below == 0) return std::nullopt;
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    return Interval{sorted[below - 1], sorted[count - below]};
}

Summary summarize(std::span<const double> values) {
    if (values.empty()) return {};
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return {values.size(), median(values), median_absolute_deviation(values),
            *least,        *most,          interval_of_median(values)};
}

Ratio ratio_of_medians(std::span<const double> numerator, std::span<const double> denominator,
                       const BootstrapOptions& options) {
    assert(!numerator.empty() && numerator.size() == denominator.size());
    const std::size_t count = numerator.size();
    Ratio ratio{median(numerator) / median(denominator), std::nullopt, count};
    if (count < 3) return ratio;

    std::vector<double> above(count), below(count), ratios;
    ratios.reserve(static_cast<std::size_t>(options.resamples));
    for (int resample = 0; resample < options.resamples; ++resample) {
        for (std::size_t draw = 0; draw < count; ++draw) {
            const std::size_t round = drawn_index(options.seed, static_cast<std::uint32_t>(resample),
                                                  static_cast<std::uint32_t>(draw), count);
            above[draw] = numerator[round];
            below[draw] = denominator[round];
        }
        ratios.push_back(median_in_place(above) / median_in_place(below));
    }
    std::sort(ratios.begin(), ratios.end());
    const double tail = (1 - options.confidence) / 2;
    ratio.interval = Interval{quantile(ratios, tail), quantile(ratios, 1 - tail)};
    return ratio;
}

std::vector<std::size_t> interleaved_order(std::size_t variants, std::size_t round) {
    std::vector<std::size_t> order(variants);
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (round % 2 == 1) std::reverse(order.begin(), order.end());
    return order;
}

}  // namespace tandem
