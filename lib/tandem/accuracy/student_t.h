/// Student's t distribution.
#pragma once

namespace tandem {

/// The probability that |t| <= `value`, for 1 or more degrees of freedom; `value` is not negative. Exact but for
/// rounding. Source: M. Abramowitz, I. Stegun, "Handbook of Mathematical Functions", 26.7.3 and 26.7.4.
[[nodiscard]] double student_t_within(double value, int degrees);

/// The value that |t| does not exceed with probability `confidence`, from 0 to below 1: 2.04 for 0.95 and 31 degrees.
[[nodiscard]] double student_t_bound(double confidence, int degrees);

}  // namespace tandem
