// Work that several processors share: every unit is taken once, what is given back is taken again.
#include "tandem/render/division.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "support/random.h"

namespace tandem {
namespace {

TEST(Division, EveryUnitIsDoneOnceWhateverIsGivenBack) {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        test::Random random(seed);
        const std::size_t units = random.below(300), step = 1 + random.below(16);
        Division division(units, step);
        std::vector<int> done(units);
        std::size_t left = units;
        while (const auto part = division.take(random.below(60))) {
            ASSERT_GT(part->count, 0U);
            ASSERT_TRUE(part->first % step == 0) << "seed " << seed;
            ASSERT_TRUE((part->first + part->count) % step == 0 || part->first + part->count == units);
            if (random.below(4) == 0) {
                division.give_back(*part);
            } else {
                for (std::size_t i = 0; i < part->count; ++i) ++done[part->first + i];
                left -= part->count;
            }
            ASSERT_EQ(division.left(), left) << "seed " << seed;
        }
        EXPECT_TRUE(division.is_empty());
        EXPECT_EQ(done, std::vector<int>(units, 1)) << "seed " << seed;
    }
}

TEST(Division, LeavesNoSmallRests) {
    Division division(100);
    EXPECT_EQ(division.take(40)->count, 40U);
    EXPECT_EQ(division.take(41)->count, 60U) << "19 would be left";
}

TEST(Division, PortionsEndTogether) {
    EXPECT_DOUBLE_EQ(fair_portion({{}, {}, {}, {}}, 2, 100), 25);
    EXPECT_DOUBLE_EQ(fair_portion({{.pace = 1}, {.pace = 3}}, 0, 100), 75);
    EXPECT_DOUBLE_EQ(fair_portion({{.pace = 2}, {}}, 1, 100), 50) << "as fast as the other, as far as is known";
    EXPECT_DOUBLE_EQ(fair_portion({{.pace = 2, .busy = 10}, {.pace = 2}}, 0, 15), 5) << "20 s: 10 + 2 * 5, 2 * 10";
    EXPECT_DOUBLE_EQ(fair_portion({{.pace = 2, .busy = 100}, {.pace = 2}}, 0, 15), 0);
    EXPECT_DOUBLE_EQ(fair_portion({{.pace = 2, .busy = 100}, {.pace = 2}}, 1, 15), 15);
    constexpr double never = std::numeric_limits<double>::infinity();
    EXPECT_DOUBLE_EQ(fair_portion({{.pace = 2, .busy = never}, {.pace = 2}, {}}, 1, 30), 15);
    EXPECT_EQ(fair_portion({{}, {}}, 0, 0), 0);
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        test::Random random(seed);
        std::vector<Worker> workers(1 + random.below(6));
        for (Worker& worker : workers)
            worker = {random.uniform(0.1, 3.0), random.coin() ? random.uniform(0.0, 90.0) : 0};
        const std::size_t left = 1 + random.below(300);
        double all = 0, end = 0;
        for (std::size_t i = 0; i < workers.size(); ++i) {
            const double portion = fair_portion(workers, i, left);
            all += portion;
            if (portion > 0) end = std::max(end, workers[i].busy + portion * workers[i].pace);
        }
        EXPECT_NEAR(all, static_cast<double>(left), 1e-9) << "seed " << seed;
        for (std::size_t i = 0; i < workers.size(); ++i) {
            const double portion = fair_portion(workers, i, left);
            if (portion > 0) {
                EXPECT_NEAR(workers[i].busy + portion * workers[i].pace, end, 1e-9) << "seed " << seed;
            } else {
                EXPECT_GE(workers[i].busy, end - 1e-9) << "seed " << seed;
            }
        }
    }
}

TEST(Division, WorkersOfSimilarPaceCountAsEqual) {
    std::vector<Worker> workers = {{.pace = 1}, {.pace = 1.9, .busy = 3}, {.pace = 2.1}, {}, {.pace = 1}};
    level(workers);
    EXPECT_DOUBLE_EQ(workers[0].pace, 1.3);
    EXPECT_DOUBLE_EQ(workers[1].pace, 1.3);
    EXPECT_DOUBLE_EQ(workers[1].busy, 3);
    EXPECT_DOUBLE_EQ(workers[2].pace, 2.1) << "twice as slow";
    EXPECT_DOUBLE_EQ(workers[3].pace, 0) << "not known";
    EXPECT_DOUBLE_EQ(workers[4].pace, 1.3);
    std::vector<Worker> unknown(2);
    level(unknown);
    EXPECT_DOUBLE_EQ(unknown[1].pace, 0);
}

TEST(Division, PartsShrinkTowardsTheEnd) {
    EXPECT_EQ(part_size(800, 2, true, 10), 400U);
    EXPECT_EQ(part_size(800, 4, true, 10), 200U);
    EXPECT_EQ(part_size(600, 4, true, 10), 150U);
    EXPECT_EQ(part_size(13, 4, true, 10), 13U) << "nothing less than 10 stays";
    EXPECT_EQ(part_size(800, 4, false, 10), 50U) << "to learn the pace";
    EXPECT_EQ(part_size(3, 4, true, 10), 10U);
    EXPECT_EQ(part_size(0, 4, true, 0), 1U);
}

}  // namespace
}  // namespace tandem
