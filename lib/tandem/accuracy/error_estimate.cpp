#include "tandem/accuracy/error_estimate.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "tandem/accuracy/student_t.h"

namespace tandem {

ErrorEstimate estimate_mean(std::span<const double> errors, double shared_variance) {
    assert(errors.size() >= 2);
    const auto count = static_cast<double>(errors.size());
    double mean = 0;
    for (const double error : errors) mean += error;
    mean /= count;
    double squares = 0;
    for (const double error : errors) squares += (error - mean) * (error - mean);
    const double deviation = std::sqrt(squares / (count - 1) / count + shared_variance);
    const double margin = student_t_bound(0.95, static_cast<int>(errors.size()) - 1) * deviation;
    if (mean > margin) {
        const double factor = std::exp(margin / mean);
        return {mean, {mean / factor, mean * factor}, true};
    }
    return {mean, {0, std::max(mean, 0.0) + margin}, false};
}

ErrorEstimate root_of(const ErrorEstimate& squared) {
    const auto root = [](double value) { return std::sqrt(std::max(value, 0.0)); };
    return {root(squared.value), {root(squared.interval.low), root(squared.interval.high)}, squared.resolved};
}

double PowerLaw::price_of_a_digit() const {
    return exponent > 0 ? std::pow(10.0, 1 / exponent) : std::numeric_limits<double>::infinity();
}

PowerLaw fit_power_law(std::span<const TimeAndError> points) {
    double count = 0, x_sum = 0, y_sum = 0;
    const auto counts = [](const TimeAndError& p) { return p.seconds > 0 && p.error > 0; };
    for (const TimeAndError& point : points) {
        if (!counts(point)) continue;
        count += 1;
        x_sum += std::log(point.seconds);
        y_sum += std::log(point.error);
    }
    if (count == 0) return {};
    const double x_mean = x_sum / count, y_mean = y_sum / count;
    double spread = 0, slope = 0;
    for (const TimeAndError& point : points) {
        if (!counts(point)) continue;
        const double x = std::log(point.seconds) - x_mean;
        spread += x * x;
        slope += x * (std::log(point.error) - y_mean);
    }
    const double exponent = spread > 0 ? -slope / spread : 0;
    return {std::exp(y_mean + exponent * x_mean), exponent};
}

std::optional<Exponent> fit_exponent(std::span<const SamplesAndError> points) {
    std::vector<TimeAndError> resolved;
    for (const SamplesAndError& point : points) {
        if (point.error.resolved && point.error.interval.low > 0) {
            resolved.push_back({point.samples, point.error.value});
        }
    }
    double mean = 0, spread = 0, margin2 = 0;
    for (const TimeAndError& point : resolved) mean += std::log(point.seconds) / static_cast<double>(resolved.size());
    for (const TimeAndError& point : resolved) spread += std::pow(std::log(point.seconds) - mean, 2);
    if (!(spread > 0)) return std::nullopt;
    for (const SamplesAndError& point : points) {
        if (!point.error.resolved || !(point.error.interval.low > 0)) continue;
        const double half = std::log(point.error.interval.high / point.error.interval.low) / 2;
        margin2 += std::pow((std::log(point.samples) - mean) / spread * half, 2);
    }
    const double value = -fit_power_law(resolved).exponent, margin = std::sqrt(margin2);
    return Exponent{value, {value - margin, value + margin}};
}

}  // namespace tandem
