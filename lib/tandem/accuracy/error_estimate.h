/// Means of errors over seeds, with intervals.
#pragma once

#include <optional>
#include <span>

#include "tandem/report/statistics.h"

namespace tandem {

/// A mean and its 95 % interval.
struct ErrorEstimate {
    double value = 0;
    Interval interval;
    /// The error is told apart from zero. Otherwise the interval begins at 0, and its upper end is a bound.
    bool resolved = false;
};

/// The mean of one error per seed, at least two of them, with the interval of Student's t on the logarithm of the mean:
/// with the standard error s, from mean * exp(-t s / mean) to mean * exp(t s / mean). So the interval is positive and
/// symmetric on a logarithmic axis. It is an interval of the mean; one from the mean of logarithms would be of the
/// median. Whole images are replicated because pixels are not independent. If t s exceeds the mean, the interval goes
/// from 0 to mean + t s (at least t s).
///
/// `shared_variance`: of what all seeds have in common (ErrorMeter::reference_variance()). Covers less than 95 % if the
/// errors of seeds have a long tail, as with rare bright pixels.
[[nodiscard]] ErrorEstimate estimate_mean(std::span<const double> errors, double shared_variance = 0);

/// The square root of an estimate of a mean square; negative ends become 0.
[[nodiscard]] ErrorEstimate root_of(const ErrorEstimate& squared);

/// The price of accuracy: error = factor * time^-exponent, by least squares of logarithms.
struct PowerLaw {
    double factor = 0;
    double exponent = 0;
    /// The factor in time for a tenth of the error. Infinite if more time does not reduce the error.
    [[nodiscard]] double price_of_a_digit() const;
};

struct TimeAndError {
    double seconds = 0;
    double error = 0;
};

/// Fits points with positive times and errors; the others are left out. Needs two with different times, or the exponent
/// is 0.
[[nodiscard]] PowerLaw fit_power_law(std::span<const TimeAndError> points);

/// How an error falls with the number of samples: error = factor * samples^value.
struct Exponent {
    double value = 0;
    Interval interval;  ///< 95 %
};

struct SamplesAndError {
    double samples = 0;
    ErrorEstimate error;
};

/// By least squares of logarithms, as fit_power_law(). The interval is that of the errors' own intervals, taken as
/// independent; it does not say whether a power law holds. Nothing if fewer than two different numbers of samples have
/// a resolved error.
[[nodiscard]] std::optional<Exponent> fit_exponent(std::span<const SamplesAndError> points);

}  // namespace tandem
