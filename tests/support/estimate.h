/// Means of random samples, with their tolerance.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace tandem::test {

class Estimate {
  public:
    void add(double value) {
        ++count_;
        const double change = value - mean_;
        mean_ += change / count_;
        squares_ += change * (value - mean_);
    }
    [[nodiscard]] double mean() const { return mean_; }
    [[nodiscard]] double variance_of_mean() const { return squares_ / (count_ * (count_ - 1)); }
    [[nodiscard]] double standard_error() const { return std::sqrt(variance_of_mean()); }
    /// Degrees of freedom of the variance.
    [[nodiscard]] double freedom() const { return count_ - 1; }

  private:
    double count_ = 0;
    double mean_ = 0;
    double squares_ = 0;  ///< sum of squared deviations
};

/// Within 4.5 standard errors, which a correct estimator misses once in 150 000 tests, plus a bound on rounding.
inline void expect_mean(const Estimate& estimate, double expected, const std::string& name) {
    EXPECT_NEAR(estimate.mean(), expected, 4.5 * estimate.standard_error() + 1e-12 * std::abs(expected)) << name;
}

}  // namespace tandem::test
