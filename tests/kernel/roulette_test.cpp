// Russian roulette keeps the mean.
#include "tandem/kernel/roulette.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/estimate.h"
#include "support/random.h"

namespace tandem {
namespace {

TEST(Roulette, TheProbabilityIsTheLargestComponentWithinItsBounds) {
    EXPECT_EQ(survival_probability(Vec3d{0.2, 0.5, 0.3}, 0.05), 0.5);
    EXPECT_EQ(survival_probability(Vec3d{0.7, 0.5, 0.3}, 0.05), 0.7);
    EXPECT_EQ(survival_probability(Vec3d{0.1, 0.5, 0.9}, 0.05), 0.9);
    EXPECT_EQ(survival_probability(Vec3d{3, 0, 0}, 0.05), 1);
    EXPECT_EQ(survival_probability(Vec3d{0, 0, 0}, 0.05), 0.05);
    const double nan = std::nan("");
    EXPECT_EQ(survival_probability(Vec3d{nan, nan, nan}, 0.05), 0.05);
    EXPECT_EQ(survival_probability(Vec3d{nan, 0.5, nan}, 0.05), 0.5);
    EXPECT_EQ(survival_probability(Vec3d{0.5, nan, HUGE_VAL}, 0.05), 1);
}

TEST(Roulette, KeepsTheMean) {
    EXPECT_TRUE(survives<float>(1.0, 1 - 0x1p-53));
    EXPECT_FALSE(survives<float>(0.5, 0.5));
    test::Random random(1);
    test::Estimate carried;
    const Vec3d throughput = {0.3, 0.1, 0.2};
    for (int i = 0; i < 100'000; ++i) {
        const double probability = survival_probability(throughput, 0.05);
        carried.add(survives<float>(probability, random.uniform(0.0, 1.0)) ? throughput.y / probability : 0);
    }
    test::expect_mean(carried, throughput.y, "seed 1");
}

}  // namespace
}  // namespace tandem
