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
    double squares = 0;  ///< of the errors of pixels: says how few pixels the sum is from
    double cubes = 0;    ///< likewise: says from how few pixels its spread is; 0: from very many

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
/// the film of all samples; `fresh`: the film of some of them; both with the plane variance. If nothing that `fresh`
/// shows decided how many samples there are, the estimate has no bias. `film_mean`: that of all pixels and channels,
/// for relmse. The square of the true value is then taken as m^2 + 3v, where m is the mean of the samples that are not
/// in `fresh`, and so independent of its variance, and v the variance of m: for small noise, the inverse of that has no
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
/// of the mean is k = sqrt(2 / n') of it. The interval has 2.5 % of films above it: a sum of squares is skewed, and the
/// more so the fewer pixels its spread is from, which `cubes` tells. Below it are fewer than 2.5 %, by the normal
/// distribution: 1 - 1.96 k, but no less than 1 / (1 + 1.96 k)^2 unless few pixels carry all. `cubes` of 0, as of FLIP:
/// 1 + 1.96 k above.
[[nodiscard]] StatedError estimate_error(const ErrorSums& errors, ErrorMetric metric);

/// The mean error of pixels, and a standard error more: sqrt(2 / n') of it.
[[nodiscard]] double cautious_mean(const ErrorSums& errors);

/// The mean error of pixels that the target is: its square for rmse.
[[nodiscard]] double mean_of_target(double target, ErrorMetric metric);

/// "0.00981, 0.0096 to 0.0101".
[[nodiscard]] std::string to_string(const StatedError& estimate);

}  // namespace tandem
