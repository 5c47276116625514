// The interval of a film's stated error, against sums of squares whose distribution is known.
#include "tandem/film/error_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/random.h"

namespace tandem {
namespace {

/// The share of films whose error is within the interval, if every pixel's error is normal with a known variance.
struct Covered {
    double within = 0, below = 0, above = 0;
};
Covered cover(const std::vector<double>& variances, std::uint64_t seed) {
    ErrorSums sums;
    sums.pixels = static_cast<double>(variances.size());
    for (const double v : variances) {
        sums += {0, v, v * v, v * v * v};
    }
    const StatedError stated = estimate_error(sums, ErrorMetric::rmse);
    test::Random random(seed);
    constexpr int films = 4000;
    Covered covered;
    for (int film = 0; film < films; ++film) {
        double square = 0;
        for (const double v : variances) {
            const double radius = std::sqrt(-2 * std::log(1 - random.uniform(0.0, 1.0)));
            const double normal = radius * std::cos(6.283185307179586 * random.uniform(0.0, 1.0));
            square += v * normal * normal;
        }
        const double error = std::sqrt(square / sums.pixels);
        covered.below += error < stated.low ? 1.0 / films : 0;
        covered.above += error > stated.high ? 1.0 / films : 0;
    }
    covered.within = 1 - covered.below - covered.above;
    return covered;
}

TEST(StatedError, CoversTheErrorHoweverFewPixelsCarryIt) {
    struct Case {
        const char* name;
        std::vector<double> variances;
    };
    std::vector<Case> cases = {{"one", {1}}, {"three", {1, 2, 1}}, {"twenty", std::vector<double>(20, 1.0)}};
    cases.push_back({"three among many", std::vector<double>(300, 0.1)});
    for (const std::size_t i : {0U, 1U, 2U}) cases.back().variances[i] = 4;
    for (const Case& one : cases) {
        const Covered covered = cover(one.variances, 1);
        EXPECT_GE(covered.within, 0.945) << one.name << ", seed 1";
        EXPECT_LE(covered.above, 0.035) << one.name << ", seed 1";
    }
    // by the normal distribution alone, more than 4 % would be above
    EXPECT_GE(cover(cases.back().variances, 2).within, 0.955);
}

TEST(StatedError, IsAboutAsNarrowAsItCanBeForManyPixels) {
    const Covered covered = cover(std::vector<double>(1000, 2.0), 1);
    EXPECT_GE(covered.within, 0.94);
    EXPECT_LE(covered.within, 0.965);
    ErrorSums sums{1000, 2000, 4000, 8000};
    const StatedError stated = estimate_error(sums, ErrorMetric::relmse);
    EXPECT_NEAR(stated.low, 2 * (1 - 1.96 * std::sqrt(2.0 / 1000)), 1e-4);
    EXPECT_NEAR(stated.high, 2 * (1 + 1.96 * std::sqrt(2.0 / 1000)), 0.006);
    EXPECT_GT(stated.high, 2 * (1 + 1.96 * std::sqrt(2.0 / 1000)));
    EXPECT_EQ(estimate_error({10, 0, 0, 0}, ErrorMetric::rmse).high, 0);
}

}  // namespace
}  // namespace tandem
