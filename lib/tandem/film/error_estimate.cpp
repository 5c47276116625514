#include "tandem/film/error_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tandem/base/error.h"
#include "tandem/film/variance.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

constexpr double normal_quantile = 1.959963984540054;  // 97.5 %

/// The quantile of the chi-squared distribution over its degrees of freedom, from the same quantile of the normal
/// distribution: E. B. Wilson, M. M. Hilferty, "The distribution of chi-square", PNAS 17, 1931. Correct within 2 % for
/// quantiles above the mean.
double chi_squared_share(double degrees, double of_normal) {
    const double c = 2 / (9 * degrees), root = std::max(1 - c + of_normal * std::sqrt(c), 0.0);
    return root * root * root;
}

/// The 97.5 % quantile of a sum of errors, above its mean and in standard deviations. A pixel's squared error is its
/// variance times a number with the chi-squared distribution of one degree of freedom. A sum of them has the first
/// three cumulants of a + b X, where X has squares^3 / cubes^2 degrees: J. P. Imhof, "Computing the distribution of
/// quadratic forms in normal variables", Biometrika 48, 1961.
double deviations_above(const ErrorSums& errors) {
    if (!(errors.cubes > 0)) return normal_quantile;
    const double ratio = errors.squares / errors.cubes;
    const double degrees = std::max(ratio * ratio * errors.squares, 1.0);
    return (chi_squared_share(degrees, normal_quantile) - 1) * std::sqrt(degrees / 2);
}

/// The lower end of the interval, as a share of the mean, for a standard error of k. The lower tail of the normal
/// distribution is heavier than that of a sum of squares; its end is kept above 0 here. If few pixels carry most of the
/// error, the quantile of the chi-squared distribution is lower and is used instead.
double share_below(const ErrorSums& errors, double k) {
    const double normal = normal_quantile * k, held = std::max(1 - normal, 1 / ((1 + normal) * (1 + normal)));
    if (!(errors.cubes > 0)) return held;
    return std::min(held, chi_squared_share(2 / (k * k), -normal_quantile));
}

/// The standard error of the mean, as a share of it.
double standard_error(const ErrorSums& errors) {
    return errors.squares > 0 ? std::sqrt(2 * errors.squares) / errors.sum : 0;
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
        errors.cubes += pixel * pixel * pixel;
    }
    return errors;
}

StatedError estimate_error(const ErrorSums& errors, ErrorMetric metric) {
    const DefaultFpEnvironment guard;
    const double mean = mean_of(errors);
    const double extra = metric == ErrorMetric::flip ? flip_model_error : 0;
    const double k = standard_error(errors);
    const double low = std::max(share_below(errors, k) - extra, 0.0), high = 1 + deviations_above(errors) * k + extra;
    const auto in_unit = [&](double square) { return metric == ErrorMetric::rmse ? std::sqrt(square) : square; };
    return {in_unit(mean), in_unit(mean * low), in_unit(mean * high)};
}

double cautious_mean(const ErrorSums& errors) { return mean_of(errors) * (1 + standard_error(errors)); }

double mean_of_target(double target, ErrorMetric metric) {
    return metric == ErrorMetric::rmse ? target * target : target;
}

std::string to_string(const StatedError& estimate) {
    return fmt::format("{:.3g}, {:.3g} to {:.3g}", estimate.value, estimate.low, estimate.high);
}

}  // namespace tandem
