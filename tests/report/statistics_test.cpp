#include "tandem/report/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tandem/kernel/sampler/philox.h"

namespace tandem {
namespace {

TEST(Statistics, MedianOfOddEvenAndOne) {
    EXPECT_EQ(median(std::vector<double>{3, 1, 2}), 2);
    EXPECT_EQ(median(std::vector<double>{4, 1, 3, 2}), 2.5);
    EXPECT_EQ(median(std::vector<double>{7}), 7);
    EXPECT_EQ(median(std::vector<double>{5, 5, 1, 5, 9, 5}), 5);
}

TEST(Statistics, OneOutlierMovesNeitherMedianNorDeviation) {
    const std::vector<double> calm = {10, 11, 12, 13, 14};
    const std::vector<double> with_outlier = {10, 11, 12, 13, 1e9};
    EXPECT_EQ(median(calm), median(with_outlier));
    EXPECT_EQ(median_absolute_deviation(calm), 1);
    EXPECT_EQ(median_absolute_deviation(with_outlier), 1);
}

TEST(Statistics, SummaryOfNothingIsZeroAndOfSomethingIsAll) {
    EXPECT_EQ(summarize({}).count, 0U);
    const std::vector<double> values = {2, 8, 4};
    const Summary summary = summarize(values);
    EXPECT_EQ(summary.count, 3U);
    EXPECT_EQ(summary.median, 4);
    EXPECT_EQ(summary.deviation, 2);
    EXPECT_EQ(summary.least, 2);
    EXPECT_EQ(summary.most, 8);
}

TEST(Statistics, RatioOfConstantsHasAnIntervalOfNoWidth) {
    const std::vector<double> twelve(9, 12), three(9, 3);
    const Ratio ratio = ratio_of_medians(twelve, three);
    EXPECT_EQ(ratio.value, 4);
    ASSERT_TRUE(ratio.interval.has_value());
    EXPECT_EQ(ratio.interval->low, 4);
    EXPECT_EQ(ratio.interval->high, 4);
    EXPECT_EQ(ratio.pairs, 9U);
}

TEST(Statistics, TwoPairsCarryNoInterval) {
    const std::vector<double> above = {4, 6}, below = {2, 2};
    EXPECT_EQ(ratio_of_medians(above, below).value, 2.5);
    EXPECT_FALSE(ratio_of_medians(above, below).interval.has_value());
}

TEST(Statistics, ASlowRoundThatHitsBothDoesNotWidenTheInterval) {
    // Load doubles both times in every other round; the ratio stays what it is.
    std::vector<double> above, below;
    for (int round = 0; round < 15; ++round) {
        const double load = round % 2 == 0 ? 1 : 2;
        above.push_back(6 * load);
        below.push_back(2 * load);
    }
    const Ratio ratio = ratio_of_medians(above, below);
    EXPECT_EQ(ratio.interval->low, 3);
    EXPECT_EQ(ratio.interval->high, 3);
}

TEST(Statistics, TheSeedDecidesTheIntervalAndTheOrderOfResamplesDoesNot) {
    const std::vector<double> above = {5, 7, 6, 9, 8, 6.5, 7.5}, below = {2, 2.5, 2.2, 2.1, 2.7, 2.4, 2.3};
    const Ratio once = ratio_of_medians(above, below);
    const Ratio again = ratio_of_medians(above, below);
    EXPECT_EQ(once.interval->low, again.interval->low);
    EXPECT_EQ(once.interval->high, again.interval->high);
    EXPECT_LT(once.interval->low, once.value);
    EXPECT_GT(once.interval->high, once.value);
}

/// Standard normal by Box and Muller.
double normal_number(std::uint32_t trial, std::uint32_t draw) {
    const auto block = philox4x32<std::uint32_t>({{trial, draw, 0, 0}}, 20, 24);
    const double u = 1 - double{to_unit_interval<float>(block.word[0])};
    const double v = double{to_unit_interval<float>(block.word[1])};
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

TEST(Statistics, NinetyFivePercentIntervalsCoverTheTrueRatioAboutThatOften) {
    // 25 rounds of log-normal times, true ratio of medians 3. 400 trials: 3 standard errors are 3.3 %. The percentile
    // bootstrap of a median is known to run a little wide.
    constexpr int trials = 400;
    int covered = 0;
    for (std::uint32_t trial = 0; trial < trials; ++trial) {
        std::vector<double> above, below;
        for (std::uint32_t round = 0; round < 25; ++round) {
            const double shared = 0.3 * normal_number(trial, 3 * round);
            above.push_back(3 * std::exp(shared + 0.1 * normal_number(trial, 3 * round + 1)));
            below.push_back(std::exp(shared + 0.1 * normal_number(trial, 3 * round + 2)));
        }
        const Ratio ratio = ratio_of_medians(above, below, {600, 0.95, trial});
        if (ratio.interval->low <= 3 && 3 <= ratio.interval->high) ++covered;
    }
    EXPECT_GE(covered, trials * 91 / 100);
    EXPECT_LE(covered, trials * 995 / 1000);
}

TEST(Statistics, RoundsGoForthAndBack) {
    EXPECT_EQ(interleaved_order(3, 0), (std::vector<std::size_t>{0, 1, 2}));
    EXPECT_EQ(interleaved_order(3, 1), (std::vector<std::size_t>{2, 1, 0}));
    EXPECT_EQ(interleaved_order(3, 2), (std::vector<std::size_t>{0, 1, 2}));
}

TEST(Statistics, IntervalOfAMedianIsTheOneOfTheTables) {
    // The ranks for 95 %: 1 and 6 of 6; 2 and 9 of 10; 10 and 23 of 32
    const auto ranks = [](int count) {
        std::vector<double> values;
        for (int i = count; i > 0; --i) values.push_back(i);
        return interval_of_median(values);
    };
    EXPECT_FALSE(ranks(5));
    EXPECT_EQ(ranks(6)->low, 1);
    EXPECT_EQ(ranks(6)->high, 6);
    EXPECT_EQ(ranks(10)->low, 2);
    EXPECT_EQ(ranks(10)->high, 9);
    EXPECT_EQ(ranks(32)->low, 10);
    EXPECT_EQ(ranks(32)->high, 23);
    EXPECT_FALSE(interval_of_median({}));
}

}  // namespace
}  // namespace tandem
