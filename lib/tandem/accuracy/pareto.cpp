#include "tandem/accuracy/pareto.h"

#include <tuple>

namespace tandem {

namespace {

bool dominates(const PricedError& better, const PricedError& worse) {
    if (better.seconds > worse.seconds || better.error.value > worse.error.value) return false;
    return better.seconds_interval.high < worse.seconds_interval.low ||
           better.error.interval.high < worse.error.interval.low;
}

/// The index of the point with the least `key`, of those that `counts` allows.
template <class Counts, class Key>
std::optional<std::size_t> least(std::span<const PricedError> points, Counts counts, Key key) {
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (counts(points[i]) && (!found || key(points[i]) < key(points[*found]))) found = i;
    }
    return found;
}

std::tuple<double, double> error_first(const PricedError& point) { return {point.error.value, point.seconds}; }

}  // namespace

std::vector<std::optional<std::size_t>> dominating(std::span<const PricedError> points) {
    std::vector<std::optional<std::size_t>> result;
    result.reserve(points.size());
    for (const PricedError& point : points) {
        result.push_back(least(
            points, [&](const PricedError& other) { return dominates(other, point); }, error_first));
    }
    return result;
}

std::optional<std::size_t> best_within(std::span<const PricedError> points, double seconds) {
    const auto in_time = [&](const PricedError& point) { return point.seconds <= seconds; };
    const std::optional<std::size_t> best = least(points, in_time, error_first);
    if (!best) return best;
    return least(
        points,
        [&](const PricedError& point) {
            return in_time(point) && point.error.interval.low <= points[*best].error.interval.high;
        },
        [](const PricedError& point) { return point.seconds; });
}

std::optional<std::size_t> fastest_within(std::span<const PricedError> points, const ErrorEstimate& error) {
    return least(
        points,
        [&](const PricedError& point) {
            return point.error.value <= error.value || point.error.interval.low <= error.interval.high;
        },
        [](const PricedError& point) { return point.seconds; });
}

}  // namespace tandem
