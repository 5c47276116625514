#include "tandem/film/error_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tandem/base/error.h"
#include "tandem/film/variance.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

/// The 97.5 % quantile of Student's distribution, from three terms of its expansion: M. Abramowitz, I. Stegun,
/// "Handbook of Mathematical Functions", 26.7.5. Within 1 % for 3 degrees of freedom or more; below that too small.
double student_quantile(double freedom) {
    constexpr double z = 1.959963984540054, z3 = z * z * z, z5 = z3 * z * z;
    return z + (z3 + z) / (4 * freedom) + (5 * z5 + 16 * z3 + 3 * z) / (96 * freedom * freedom);
}

/// Of the mean, as a share of it.
double standard_error(const ErrorSums& errors) {
    return errors.squares > 0 ? std::sqrt(2 * errors.squares) / errors.sum : 0;
}

/// How far the interval goes above the mean, as a share of it.
double spread(const ErrorSums& errors) {
    if (!(errors.squares > 0)) return 0;
    const double carriers = errors.sum * errors.sum / errors.squares;
    return student_quantile(std::max(carriers - 1, 1.0)) * standard_error(errors);
}

double mean_of(const ErrorSums& errors) { return errors.pixels > 0 ? errors.sum / errors.pixels : 0; }

}  // namespace

const char* to_string(ErrorMetric metric) {
    switch (metric) {
        case ErrorMetric::rmse:
            return "rmse";
        case ErrorMetric::relmse:
            return "relmse";
        case ErrorMetric::flip:
            return "flip";
    }
    return "";
}

ErrorMetric parse_metric(std::string_view name) {
    for (const ErrorMetric metric : {ErrorMetric::rmse, ErrorMetric::relmse, ErrorMetric::flip}) {
        if (name == to_string(metric)) return metric;
    }
    throw InputError(fmt::format("there is no metric '{}'; the metrics are rmse, relmse and flip", name));
}

ErrorSums squared_errors(const Film& all, const Film& fresh, ErrorMetric metric, double film_mean) {
    const DefaultFpEnvironment guard;
    const Vec3d *const squares = fresh.planes().variance, *const all_squares = all.planes().variance;
    const double samples = all.samples(), part = fresh.samples();
    const bool has_others = samples > part;
    const double others = has_others ? samples - part : samples;
    const double floor = relmse_floor * film_mean * film_mean;
    ErrorSums errors;
    errors.pixels = static_cast<double>(fresh.pixel_count());
    for (std::size_t i = 0; i < fresh.pixel_count(); ++i) {
        const auto of_channel = [&](double all_sum, double all_square, double sum, double square) {
            const double variance = variance_of_mean(sum, square, part) * (part / samples);
            if (metric == ErrorMetric::rmse || variance == 0) return variance;
            const double other_sum = has_others ? all_sum - sum : all_sum;
            const double other_square = has_others ? all_square - square : all_square;
            const double mean = other_sum / others;
            return variance / (mean * mean + 3 * variance_of_mean(other_sum, other_square, others) + floor);
        };
        const Vec3d &a = all.sums()[i], &a2 = all_squares[i], &f = fresh.sums()[i], &f2 = squares[i];
        const double pixel =
            (of_channel(a.x, a2.x, f.x, f2.x) + of_channel(a.y, a2.y, f.y, f2.y) + of_channel(a.z, a2.z, f.z, f2.z)) /
            3;
        errors.sum += pixel;
        errors.squares += pixel * pixel;
    }
    return errors;
}

StatedError estimate_error(const ErrorSums& errors, ErrorMetric metric) {
    const DefaultFpEnvironment guard;
    const double mean = mean_of(errors);
    const double k = spread(errors) + (metric == ErrorMetric::flip ? flip_model_error : 0);
    const auto in_unit = [&](double square) { return metric == ErrorMetric::rmse ? std::sqrt(square) : square; };
    return {in_unit(mean), in_unit(mean * std::max(1 - k, 1 / ((1 + k) * (1 + k)))), in_unit(mean * (1 + k))};
}

double cautious_mean(const ErrorSums& errors) { return mean_of(errors) * (1 + standard_error(errors)); }

double mean_of_target(double target, ErrorMetric metric) {
    return metric == ErrorMetric::rmse ? target * target : target;
}

std::string to_string(const StatedError& estimate) {
    return fmt::format("{:.3g}, {:.3g} to {:.3g}", estimate.value, estimate.low, estimate.high);
}

}  // namespace tandem
