// One light stands for all: on average it brings what they bring together, each of them its share.
#include "tandem/kernel/light_reservoir.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/light_shares.h"
#include "tandem/kernel/direct_light.h"

namespace tandem {
namespace {

using test::light_of;

IncidentLight<float> choose(const std::vector<IncidentLight<float>>& lights, std::uint32_t number) {
    LightReservoir<float> choice(philox4x32<std::uint32_t>({{number, 0, 0, 0}}, 3, 4));
    for (const auto& one : lights) choice.offer(one);
    return choice.chosen();
}

TEST(LightReservoir, BringsWhatAllBringOnAverage) {
    const std::vector<IncidentLight<float>> lights = {light_of({1, 0, 0}, 0), light_of({0, 0, 0}, 1),
                                                      light_of({0.5F, 2, 0.5F}, 2), light_of({0, 0, 6}, 3)};
    Vec3d sum = {0, 0, 0};
    std::vector<double> counts(lights.size(), 0);
    constexpr int draws = 400'000;
    for (std::uint32_t i = 0; i < draws; ++i) {
        const auto chosen = choose(lights, i);
        sum = sum + widen(chosen.reflected);
        ++counts[chosen.primitive];
    }
    // the standard errors of shares are below 8e-4, and what is brought is up to ten times that
    EXPECT_NEAR(sum.x / draws, 1.5, 0.03);
    EXPECT_NEAR(sum.y / draws, 2, 0.03);
    EXPECT_NEAR(sum.z / draws, 6.5, 0.03);
    EXPECT_NEAR(counts[0] / draws, 0.1, 4e-3);
    EXPECT_EQ(counts[1], 0) << "brings nothing";
    EXPECT_NEAR(counts[2] / draws, 0.3, 4e-3);
    EXPECT_NEAR(counts[3] / draws, 0.6, 4e-3);
}

// The chance of the later of two lights, over all numbers: counted at every place where the decision may turn.
TEST(LightReservoir, GivesTheWeakTheirShare) {
    for (const float ratio : {1e-12F, 3e-11F, 1e-9F, 2e-8F, 1e-7F, 1e-6F, 1e-3F, 0.3F, 1.0F, 7.0F, 1e6F, 1e12F}) {
        const double chance = test::chance_of_second<float>(1.0F, ratio);
        const double right = double{ratio} / (1 + double{ratio});
        EXPECT_NEAR(chance / right, 1, 1e-8) << ratio;
        const double precise = test::chance_of_second<double>(1.0, double{ratio});
        EXPECT_NEAR(precise / right, 1, 1e-8) << ratio;
    }
}

// Of equal lights each is chosen as often: chi-square with count - 1 degrees of freedom.
TEST(LightReservoir, TreatsEqualLightsAlike) {
    for (const std::uint32_t count : {3U, 40U, 300U}) {
        std::vector<IncidentLight<float>> lights;
        for (std::uint32_t i = 0; i < count; ++i) lights.push_back(light_of({1, 1, 1}, i));
        constexpr std::uint32_t draws = 60'000;
        std::vector<double> seen(count, 0);
        for (std::uint32_t i = 0; i < draws; ++i) {
            const auto chosen = choose(lights, i);
            ++seen[chosen.primitive];
            ASSERT_FLOAT_EQ(chosen.reflected.x, static_cast<float>(count));
        }
        const double expected = double{draws} / count;
        double chi2 = 0;
        for (const double n : seen) chi2 += (n - expected) * (n - expected) / expected;
        EXPECT_NEAR(chi2, count - 1, 5 * std::sqrt(2.0 * (count - 1))) << count;
    }
}

TEST(LightReservoir, IsNotChangedByLightsThatBringNothing) {
    const std::vector<IncidentLight<float>> lights = {light_of({1, 0, 0}, 0), light_of({0.2F, 0.3F, 0.1F}, 1),
                                                      light_of({0, 0, 2}, 2)};
    std::vector<IncidentLight<float>> more;
    for (const auto& light : lights) {
        for (int i = 0; i < 3; ++i) more.push_back(light_of({0, 0, 0}, 7));
        more.push_back(light);
    }
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const auto a = choose(lights, i), b = choose(more, i);
        ASSERT_EQ(a.primitive, b.primitive) << i;
        ASSERT_EQ(a.reflected, b.reflected) << i;
    }
}

TEST(LightReservoir, LeavesASingleLightAsItIs) {
    for (std::uint32_t i = 0; i < 100; ++i) {
        const auto chosen =
            choose({light_of({0, 0, 0}, 1), light_of({0.1F, 0.7F, 0.3F}, 2), light_of({0, 0, 0}, 3)}, i);
        EXPECT_EQ(chosen.reflected, Vec3f(0.1F, 0.7F, 0.3F)) << i;
        EXPECT_EQ(chosen.primitive, 2U);
    }
}

TEST(LightReservoir, OfNothingIsBlack) {
    EXPECT_EQ(choose({}, 5).reflected, Vec3f(0, 0, 0));
    EXPECT_EQ(choose({light_of({0, 0, 0}, 1)}, 5).reflected, Vec3f(0, 0, 0));
}

TEST(LightReservoir, DoesNotHideWhatIsNotANumber) {
    for (const float bad : {INFINITY, NAN}) {
        const auto broken = light_of({bad, 0, 0}, 1);
        for (std::uint32_t i = 0; i < 100; ++i) {
            const auto chosen = choose({light_of({1, 1, 1}, 0), broken, light_of({2, 2, 2}, 2)}, i);
            EXPECT_FALSE(std::isfinite(chosen.reflected.x)) << i;
        }
    }
}

}  // namespace
}  // namespace tandem
