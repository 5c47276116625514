/// The error of a film, estimated from the spread of its own samples (docs/long-renders.md says what that can miss).
#pragma once

#include <string>
#include <string_view>

#include "tandem/film/film.h"

namespace tandem {

/// rmse: the root of the mean squared error over pixels and channels, in units of radiance. relmse: the mean of squared
/// errors, each divided by the square of the true value plus `relmse_floor` times the square of the film's mean. flip:
/// the mean of FLIP over pixels, as a screen shows the film (images/flip.h).
enum class ErrorMetric { rmse, relmse, flip };

inline constexpr double relmse_floor = 1e-2;

/// How far an estimate of FLIP may be from its expectation, as a share of it: the truth that it is estimated with is
/// not the truth (docs/long-renders.md has the measurements). Its interval is wider by as much at both ends.
inline constexpr double flip_model_error = 0.05;

[[nodiscard]] const char* to_string(ErrorMetric metric);

/// Throws InputError that lists the names.
[[nodiscard]] ErrorMetric parse_metric(std::string_view name);

/// Sums over pixels of their expected errors: squared for rmse, squared and relative for relmse. All operations are
/// correctly rounded, so decisions by these sums are the same on every machine.
struct ErrorSums {
    double pixels = 0;
    double sum = 0;
    double squares = 0;  ///< of the errors of pixels: tells how few pixels the sum comes from
    double cubes = 0;    ///< likewise: tells how few pixels its spread comes from; 0: very many

    ErrorSums& operator+=(const ErrorSums& other) {
        pixels += other.pixels;
        sum += other.sum;
        squares += other.squares;
        cubes += other.cubes;
        return *this;
    }
    ErrorSums& operator-=(const ErrorSums& other) {
        pixels -= other.pixels;
        sum -= other.sum;
        squares -= other.squares;
        cubes -= other.cubes;
        return *this;
    }
};

/// The sums if all errors were `factor` times as large.
[[nodiscard]] inline ErrorSums scaled(const ErrorSums& errors, double factor) {
    return {errors.pixels, errors.sum * factor, errors.squares * factor * factor,
            errors.cubes * factor * factor * factor};
}

/// The expected squared error of each pixel's mean over all samples, from the variance of later samples alone. `all`:
/// the film of all samples; `fresh`: the film of some of them; both with the plane variance. The estimate has no bias
/// if the number of samples was chosen without regard to `fresh`. `film_mean`: that of all pixels and channels, for
/// relmse. The square of the true value is then taken as m^2 + 3v, where m is the mean of the samples that are not in
/// `fresh`, and so independent of its variance, and v the variance of m: for small noise, the inverse of that has no
/// bias of second order. Not for flip.
[[nodiscard]] ErrorSums squared_errors(const Film& all, const Film& fresh, ErrorMetric metric, double film_mean);

/// An error in the unit of its metric, with the interval that has the error of the film at hand in 95 % of films.
struct StatedError {
    double value = 0;
    double low = 0;
    double high = 0;
};

/// From the errors of pixels. With n' = sum^2 / squares, the number of pixels that carry the error, the mean squared
/// error of a film and its estimate differ by a relative variance of at most 2 / n': that of the error itself is (2 +
/// kurtosis / N), that of the estimate from n of N samples (2 / (n - 1) + kurtosis / n), and the expectation of
/// `squares` is higher than the squared variances by the factor (1 + 2 / (n - 1) + kurtosis / n). So the standard error
/// of the mean is k = sqrt(2 / n') of it. The errors of 2.5 % of films are above the interval: a sum of squares is
/// skewed, the more so the fewer pixels its spread comes from, which `cubes` tells. Those of fewer than 2.5 % are below
/// it: the lower end is that of the normal distribution, 1 - 1.96 k, but no less than 1 / (1 + 1.96 k)^2 unless few
/// pixels carry all. If `cubes` is 0, as for FLIP, the upper end is 1 + 1.96 k.
[[nodiscard]] StatedError estimate_error(const ErrorSums& errors, ErrorMetric metric);

/// The mean error of pixels plus its standard error, sqrt(2 / n') of it.
[[nodiscard]] double cautious_mean(const ErrorSums& errors);

/// The target as a mean error of pixels: its square for rmse.
[[nodiscard]] double mean_of_target(double target, ErrorMetric metric);

/// "0.00981, 0.0096 to 0.0101".
[[nodiscard]] std::string to_string(const StatedError& estimate);

}  // namespace tandem
