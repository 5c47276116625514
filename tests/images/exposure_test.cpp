#include "tandem/images/exposure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace tandem {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// One row of greys: `count` pixels of each.
FloatImage greys(std::initializer_list<std::pair<int, float>> parts) {
    FloatImage image{0, 1, {}};
    for (const auto& [count, grey] : parts) {
        image.width += count;
        image.pixels.insert(image.pixels.end(), static_cast<std::size_t>(count), Vec3f{grey, grey, grey});
    }
    return image;
}

TEST(AutoExposure, BringsAnEvenPictureToMiddleGrey) {
    EXPECT_EQ(auto_exposure(greys({{100, 0.18F}})), 0);
    EXPECT_EQ(auto_exposure(greys({{100, 1.44F}})), -3);
    EXPECT_EQ(auto_exposure(greys({{1, 0.18F / 1024}})), 10);
    EXPECT_EQ(auto_exposure(greys({{100, 0.2F}})), -0.2) << "tenths of a stop: log2(0.9) is -0.152";
    EXPECT_EQ(auto_exposure(greys({{50, 0.09F}, {50, 0.36F}})), 0) << "the geometric mean";
}

TEST(AutoExposure, CountsColoursByTheirLuminance) {
    EXPECT_EQ(auto_exposure({1, 1, {{0, 0.18F / 0.71517F, 0}}}), 0);
    EXPECT_EQ(auto_exposure({1, 1, {{0.18F / 0.21264F, 0, 0}}}), 0);
    EXPECT_EQ(auto_exposure({1, 1, {{0, 0, 0.18F / 0.07219F}}}), 0);
}

TEST(AutoExposure, IsNotDecidedByAFewPixels) {
    EXPECT_EQ(auto_exposure(greys({{960, 0.18F}, {40, 1e9F}})), 0) << "lamps";
    EXPECT_EQ(auto_exposure(greys({{920, 0.18F}, {80, 1e-9F}})), 0) << "cracks";
}

TEST(AutoExposure, KeepsAllButATwentiethBelowWhite) {
    EXPECT_EQ(auto_exposure(greys({{940, 0.18F}, {60, 64}})), -6);
    EXPECT_EQ(auto_exposure(greys({{500, 0.001F}, {500, 0.5F}})), 1) << "a bright half";
}

TEST(AutoExposure, PassesOverWhatIsBlackOrNotFinite) {
    EXPECT_EQ(auto_exposure(greys({{5, 0.36F}, {90, 0}, {90, -1}, {90, nan}, {90, infinity}, {9, -infinity}})), -1);
    FloatImage mixed = greys({{50, 0.36F}});
    mixed.width += 3;
    mixed.pixels.insert(mixed.pixels.end(), {{nan, 9, 9}, {9, infinity, 9}, {9, 9, -infinity}});
    EXPECT_EQ(auto_exposure(mixed), -1) << "of which one channel is not";
    EXPECT_EQ(auto_exposure(greys({{9, 0}, {9, nan}, {9, -2}})), 0) << "nothing is left";
    EXPECT_EQ(auto_exposure({}), 0);
}

TEST(AutoExposure, StaysWithinWhatAnExposureCanBe) {
    EXPECT_EQ(auto_exposure(greys({{9, 3e38F}})), -100);
    EXPECT_EQ(auto_exposure(greys({{9, 2e-38F}})), 100);
}

TEST(AutoExposure, IsThatOfTheDefinition) {
    for (unsigned int seed = 0; seed < 40; ++seed) {
        std::mt19937 random(seed);
        std::lognormal_distribution<double> any(-3 + 0.2 * seed, 0.1 * seed);
        FloatImage image{1 + static_cast<int>(random() % 300), 1, {}};
        std::vector<long double> logs;
        for (int i = 0; i < image.width; ++i) {
            const auto grey = static_cast<float>(any(random));
            image.pixels.push_back({grey, grey, grey});
            logs.push_back(std::log2(static_cast<long double>(grey)));
        }
        std::shuffle(image.pixels.begin(), image.pixels.end(), random);
        std::sort(logs.begin(), logs.end());
        const std::size_t count = logs.size(), tail = count / 10;
        long double sum = 0;
        for (std::size_t i = tail; i < count - tail; ++i) sum += logs[i];
        const long double middle = std::log2(0.18L) - sum / static_cast<long double>(count - 2 * tail);
        const double right = static_cast<double>(std::min(middle, -logs[count - 1 - count / 20]));
        EXPECT_NEAR(auto_exposure(image), right, 0.05001) << "seed " << seed;
    }
}

}  // namespace
}  // namespace tandem
