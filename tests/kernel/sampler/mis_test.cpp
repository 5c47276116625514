// The weights of two techniques share one, also where a density is 0 or infinite.
#include "tandem/kernel/sampler/mis.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"

namespace tandem {
namespace {

constexpr double infinite = HUGE_VAL;

TEST(Mis, AgreesWithTheFormulas) {
    for (std::uint64_t number = 0; number < 10'000; ++number) {
        test::Random random(number);
        const double a = std::exp2(random.uniform(-40.0, 40.0));
        const double b = std::exp2(random.uniform(-40.0, 40.0));
        const double power = a * a / (a * a + b * b);
        ASSERT_NEAR(balance_heuristic(a, b), a / (a + b), 4e-16) << "case " << number;
        ASSERT_NEAR(power_heuristic(a, b), power, 4e-16) << "case " << number;
        ASSERT_NEAR(balance_heuristic(a, b) + balance_heuristic(b, a), 1, 4e-16) << "case " << number;
        ASSERT_NEAR(power_heuristic(a, b) + power_heuristic(b, a), 1, 4e-16) << "case " << number;
    }
    EXPECT_EQ(balance_heuristic(3.0, 1.0), 0.75);
    EXPECT_DOUBLE_EQ(power_heuristic(3.0, 1.0), 0.9);
}

TEST(Mis, ZeroAndInfiniteDensitiesHaveAWeight) {
    for (const auto& heuristic : {&balance_heuristic<double>, &power_heuristic<double>}) {
        EXPECT_EQ(heuristic(0, 0), 0);
        EXPECT_EQ(heuristic(0, 1), 0);
        EXPECT_EQ(heuristic(1, 0), 1);
        EXPECT_EQ(heuristic(0, infinite), 0);
        EXPECT_EQ(heuristic(infinite, 0), 1);
        EXPECT_EQ(heuristic(infinite, 1), 1);
        EXPECT_EQ(heuristic(1, infinite), 0);
        EXPECT_EQ(heuristic(infinite, infinite), 0.5);
        EXPECT_EQ(heuristic(1e308, 1e308), 0.5) << "the sum overflows";
        EXPECT_EQ(heuristic(4e-324, 4e-324), 0.5) << "the square underflows";
        EXPECT_EQ(heuristic(1e300, 1e-300), 1);
        EXPECT_EQ(heuristic(1e-300, 1e300), 0);
    }
}

}  // namespace
}  // namespace tandem
