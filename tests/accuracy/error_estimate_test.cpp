#include "tandem/accuracy/error_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "noisy_images.h"
#include "tandem/accuracy/image_errors.h"
#include "tandem/accuracy/student_t.h"

namespace tandem {
namespace {

using test::Random;

TEST(StudentT, AgreesWithTheTables) {
    // Abramowitz and Stegun, table 26.10: 95 % within
    EXPECT_NEAR(student_t_bound(0.95, 1), 12.706, 1e-3);
    EXPECT_NEAR(student_t_bound(0.95, 2), 4.303, 1e-3);
    EXPECT_NEAR(student_t_bound(0.95, 3), 3.182, 1e-3);
    EXPECT_NEAR(student_t_bound(0.95, 10), 2.228, 1e-3);
    EXPECT_NEAR(student_t_bound(0.95, 30), 2.042, 1e-3);
    EXPECT_NEAR(student_t_bound(0.95, 120), 1.980, 1e-3);
    EXPECT_NEAR(student_t_bound(0.99, 5), 4.032, 1e-3);
    EXPECT_DOUBLE_EQ(student_t_within(1, 1), 0.5) << "Cauchy's quartile";
    EXPECT_EQ(student_t_within(0, 7), 0);
}

/// The share of `trials` whose interval contains `truth`.
template <class Trial>
double coverage(int trials, double truth, Trial trial) {
    int covered = 0;
    for (int i = 0; i < trials; ++i) {
        const ErrorEstimate estimate = trial();
        covered += estimate.interval.low <= truth && truth <= estimate.interval.high ? 1 : 0;
    }
    return static_cast<double>(covered) / trials;
}

// Images of 32 seeds whose noise is known, against two new references in each trial. 95 % of 1000 has a standard
// deviation of 0.7 %.
TEST(ErrorEstimate, IntervalCoversTheTruthInNinetyFiveTrialsOfAHundred) {
    struct Case {
        double bias, noise, reference_noise;
    };
    for (const Case& c : {Case{0, 0.1, 0.01}, Case{0, 0.1, 0.1}, Case{0.05, 0.02, 0.02}}) {
        constexpr std::uint64_t seed = 2;
        Random random(seed);
        const double truth = c.bias * c.bias + c.noise * c.noise;
        const double covered = coverage(1000, truth, [&] {
            const Reference pair{test::noisy_image(random, 8, 8, 1, c.reference_noise),
                                 test::noisy_image(random, 8, 8, 1, c.reference_noise)};
            ErrorMeter meter(pair);
            std::vector<double> errors(32);
            for (double& error : errors) {
                error = meter.add(test::noisy_image(random, 8, 8, 1 + c.bias, c.noise)).squared;
            }
            return estimate_mean(errors, meter.reference_variance().squared);
        });
        EXPECT_NEAR(covered, 0.95, 0.025)
            << "seed " << seed << ", bias " << c.bias << ", noise " << c.noise << ", reference " << c.reference_noise;
    }
}

// The same without the references' part: the interval is then too narrow, so the part is needed.
TEST(ErrorEstimate, WithoutTheNoiseOfReferencesTheIntervalIsTooNarrow) {
    Random random(3);
    const double covered = coverage(400, 0.05 * 0.05 + 0.02 * 0.02, [&] {
        const Reference pair{test::noisy_image(random, 8, 8, 1, 0.02), test::noisy_image(random, 8, 8, 1, 0.02)};
        ErrorMeter meter(pair);
        std::vector<double> errors(32);
        for (double& error : errors) error = meter.add(test::noisy_image(random, 8, 8, 1.05, 0.02)).squared;
        return estimate_mean(errors);
    });
    EXPECT_LT(covered, 0.7);
}

// Skewed errors: squares of one normal number, as of an image that is one pixel.
TEST(ErrorEstimate, IntervalOfSkewedErrorsIsOfTheMean) {
    Random random(4);
    const double covered = coverage(2000, 1, [&] {
        std::vector<double> errors(32);
        for (double& error : errors) error = std::pow(test::normal(random), 2);
        return estimate_mean(errors);
    });
    EXPECT_GT(covered, 0.9);
    EXPECT_LT(covered, 0.97);
}

TEST(ErrorEstimate, SaysWhenAnErrorCannotBeToldFromZero) {
    const std::vector<double> errors = {-1, 1, -2, 2.5};
    const ErrorEstimate estimate = estimate_mean(errors);
    EXPECT_FALSE(estimate.resolved);
    EXPECT_EQ(estimate.interval.low, 0);
    EXPECT_GT(estimate.interval.high, estimate.value);
    const ErrorEstimate root = root_of(estimate_mean(std::vector<double>{-3, -3.5, -2}));
    EXPECT_EQ(root.value, 0);
    EXPECT_GT(root.interval.high, 0);
    const ErrorEstimate none = estimate_mean(std::vector<double>{0, 0, 0});
    EXPECT_EQ(none.interval.high, 0);
    const ErrorEstimate clear = root_of(estimate_mean(std::vector<double>{4, 4, 4}));
    EXPECT_TRUE(clear.resolved);
    EXPECT_EQ(clear.value, 2);
}

TEST(PowerLaw, OfNoiseSaysThatADigitCostsAHundredTimes) {
    std::vector<TimeAndError> points;
    for (const double seconds : {0.1, 0.4, 1.6, 6.4}) points.push_back({seconds, 0.3 / std::sqrt(seconds)});
    points.push_back({1, 0});  // cannot be on logarithmic axes
    const PowerLaw law = fit_power_law(points);
    EXPECT_NEAR(law.exponent, 0.5, 1e-12);
    EXPECT_NEAR(law.factor, 0.3, 1e-12);
    EXPECT_NEAR(law.price_of_a_digit(), 100, 1e-9);
}

TEST(Exponent, IsThatOfTheErrorsWithTheirInterval) {
    std::vector<SamplesAndError> points;
    for (const double samples : {1.0, 4.0, 16.0, 64.0}) {
        const double error = 3 * std::pow(samples, -1.5);
        points.push_back({samples, {error, {error / 1.1, error * 1.1}, true}});
    }
    points.push_back({256, {1e-3, {0, 2e-3}, false}});  // says nothing
    const Exponent found = fit_exponent(points).value();
    EXPECT_NEAR(found.value, -1.5, 1e-12);
    // deviations of the logarithms of samples from their mean: -1.5, -0.5, 0.5, 1.5 times log 4
    const double margin = std::log(1.1) / (std::sqrt(5.0) * std::log(4.0));
    EXPECT_NEAR(found.interval.low, -1.5 - margin, 1e-12);
    EXPECT_NEAR(found.interval.high, -1.5 + margin, 1e-12);
    points.resize(1);
    EXPECT_FALSE(fit_exponent(points));
    EXPECT_FALSE(fit_exponent({}));
}

// Errors with a known spread: the interval has the exponent in about 95 of 100 cases.
TEST(Exponent, IntervalCoversTheExponent) {
    Random random(7);
    constexpr double spread = 0.05;  // of the logarithm
    const double covered = coverage(2000, -0.7, [&] {
        std::vector<SamplesAndError> points;
        for (const double samples : {1.0, 4.0, 16.0, 64.0}) {
            const double error = std::pow(samples, -0.7) * std::exp(spread * test::normal(random));
            const double factor = std::exp(1.96 * spread);
            points.push_back({samples, {error, {error / factor, error * factor}, true}});
        }
        const Exponent found = fit_exponent(points).value();
        return ErrorEstimate{found.value, found.interval, true};
    });
    EXPECT_NEAR(covered, 0.95, 0.02);
}

TEST(PowerLaw, OfABiasSaysThatTimeDoesNotHelp) {
    const std::vector<TimeAndError> points = {{1, 0.2}, {10, 0.2}};
    EXPECT_TRUE(std::isinf(fit_power_law(points).price_of_a_digit()));
    EXPECT_EQ(fit_power_law({}).exponent, 0);
    EXPECT_EQ(fit_power_law(std::vector<TimeAndError>{{1, 1}}).exponent, 0);
}

}  // namespace
}  // namespace tandem
