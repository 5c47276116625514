#include "tandem/report/row.h"

#include <gtest/gtest.h>

namespace tandem {
namespace {

BenchmarkRow measured(const std::string& label, std::vector<std::int32_t> rounds, std::vector<double> seconds) {
    BenchmarkRow row;
    row.label = label;
    row.rounds = std::move(rounds);
    row.seconds = std::move(seconds);
    return row;
}

TEST(Row, RatesComeFromTheMedian) {
    BenchmarkRow row = measured("a", {0, 1, 2}, {2, 4, 100});
    row.samples = 8;
    row.rays = 20;
    EXPECT_EQ(samples_per_second(row), 2);
    EXPECT_EQ(rays_per_second(row), 5);
    EXPECT_EQ(samples_per_second(BenchmarkRow{}), 0);
}

TEST(Row, FactorsUseOnlyTheRoundsThatBothHave) {
    const BenchmarkRow slow = measured("slow", {40, 0, 80}, {100, 10, 30});
    const BenchmarkRow fast = measured("fast", {0, 20, 40, 60, 80}, {1, 99, 5, 99, 2});
    const auto factor = factor_over(slow, fast);
    ASSERT_TRUE(factor.has_value());
    EXPECT_EQ(factor->over, "slow");
    EXPECT_EQ(factor->ratio.pairs, 3U);
    EXPECT_EQ(factor->ratio.value, 15);  // 30 / 2
    EXPECT_FALSE(factor_over(slow, measured("other", {7}, {1})).has_value());
}

TEST(Row, PhasesAreMadeOnFirstUse) {
    BenchmarkRow row;
    phase(row, "render").seconds.push_back(1);
    phase(row, "download").seconds.push_back(2);
    phase(row, "render").seconds.push_back(3);
    ASSERT_EQ(row.phases.size(), 2U);
    EXPECT_EQ(row.phases[0].seconds.size(), 2U);
}

}  // namespace
}  // namespace tandem
