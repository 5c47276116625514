// One light stands for all: on average it brings what they bring together.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tandem/integrator/direct_light.h"

namespace tandem {
namespace {

IncidentLight<float> light(float red, float green, float blue, std::uint32_t primitive) {
    IncidentLight<float> result = {{red, green, blue}, {0, 0, 1}};
    result.primitive = primitive;
    return result;
}

IncidentLight<float> choose(const std::vector<IncidentLight<float>>& lights, float u) {
    LightChoice<float> choice(u);
    for (const auto& one : lights) choice.offer(one);
    return choice.chosen();
}

TEST(LightChoice, BringsWhatAllBringOnAverage) {
    const std::vector<IncidentLight<float>> lights = {light(1, 0, 0, 0), light(0, 0, 0, 1), light(0.5F, 2, 0.5F, 2),
                                                      light(0, 0, 6, 3)};
    Vec3d sum = {0, 0, 0};
    std::vector<int> counts(lights.size(), 0);
    constexpr int steps = 100000;  // through the interval of u
    for (int i = 0; i < steps; ++i) {
        const auto chosen = choose(lights, (static_cast<float>(i) + 0.5F) / steps);
        sum = sum + widen(chosen.reflected);
        ++counts[chosen.primitive];
    }
    EXPECT_NEAR(sum.x / steps, 1.5, 1e-3);
    EXPECT_NEAR(sum.y / steps, 2, 1e-3);
    EXPECT_NEAR(sum.z / steps, 6.5, 1e-3);
    EXPECT_NEAR(counts[0], steps * 0.1, 10);
    EXPECT_EQ(counts[1], 0) << "brings nothing";
    EXPECT_NEAR(counts[2], steps * 0.3, 10);
    EXPECT_NEAR(counts[3], steps * 0.6, 10);
}

TEST(LightChoice, LeavesASingleLightAsItIs) {
    for (const float u : {0.0F, 0.3F, 1 - 0x1p-24F}) {
        const auto chosen = choose({light(0, 0, 0, 1), light(0.1F, 0.7F, 0.3F, 2), light(0, 0, 0, 3)}, u);
        EXPECT_EQ(chosen.reflected, Vec3f(0.1F, 0.7F, 0.3F)) << u;
        EXPECT_EQ(chosen.primitive, 2U);
    }
}

TEST(LightChoice, OfNothingIsBlack) {
    EXPECT_EQ(choose({}, 0.5F).reflected, Vec3f(0, 0, 0));
    EXPECT_EQ(choose({light(0, 0, 0, 1)}, 0.5F).reflected, Vec3f(0, 0, 0));
}

TEST(LightChoice, DoesNotHideWhatIsNotANumber) {
    const auto broken = light(INFINITY, 0, 0, 1);
    for (const float u : {0.0F, 0.5F, 0.99F}) {
        EXPECT_FALSE(std::isfinite(choose({light(1, 1, 1, 0), broken, light(2, 2, 2, 2)}, u).reflected.x)) << u;
    }
}

}  // namespace
}  // namespace tandem
