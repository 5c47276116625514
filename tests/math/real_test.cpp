#include "tandem/math/real.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/random.h"

namespace tandem {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Real, RoundDownIsTheLargestFloatNotAbove) {
    test::Random random(1);
    for (int i = 0; i < 1 << 18; ++i) {
        // any double within the range of float, and doubles next to floats
        const auto near = static_cast<double>(random.any_float());
        double a = random.coin() ? double_of(static_cast<std::int64_t>(random.bits())) : near;
        if (random.coin()) a = std::nextafter(a, random.coin() ? infinity : -infinity);
        if (!(std::abs(a) <= static_cast<double>(std::numeric_limits<float>::max()))) continue;
        const float down = round_down(a);
        const float up = round_up(a);
        ASSERT_LE(static_cast<double>(down), a) << std::hexfloat << a;
        ASSERT_GE(static_cast<double>(up), a) << std::hexfloat << a;
        ASSERT_GT(static_cast<double>(std::nextafter(down, HUGE_VALF)), a) << std::hexfloat << a;
        ASSERT_LT(static_cast<double>(std::nextafter(up, -HUGE_VALF)), a) << std::hexfloat << a;
    }
}

TEST(Real, RoundDownAndUpAtTheEdges) {
    const float least = std::numeric_limits<float>::denorm_min();
    EXPECT_EQ(round_down(0.0), 0.0F);
    EXPECT_EQ(round_down(-0.0), 0.0F);
    EXPECT_EQ(round_down(1e-300), 0.0F);
    EXPECT_EQ(round_up(1e-300), least);
    EXPECT_EQ(round_down(-1e-300), -least);
    EXPECT_EQ(round_up(-1e-300), 0.0F);
    EXPECT_EQ(round_down(1e39), std::numeric_limits<float>::max());
    EXPECT_EQ(round_up(-1e39), -std::numeric_limits<float>::max());
    EXPECT_EQ(round_down(-1e39), -HUGE_VALF);
}

// What the libraries' fminf and fmaxf leave open: the first argument stays on a tie and beside a NaN.
TEST(Real, LesserAndGreaterKeepTheFirstArgument) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(std::signbit(lesser(0.0F, -0.0F)));
    EXPECT_TRUE(std::signbit(lesser(-0.0F, 0.0F)));
    EXPECT_FALSE(std::signbit(greater(0.0F, -0.0F)));
    EXPECT_TRUE(std::signbit(greater(-0.0F, 0.0F)));
    EXPECT_TRUE(std::isnan(lesser(nan, 1.0F)));
    EXPECT_EQ(lesser(1.0F, nan), 1.0F);
    EXPECT_TRUE(std::isnan(greater(nan, 1.0F)));
    EXPECT_EQ(greater(1.0F, nan), 1.0F);
    EXPECT_EQ(lesser(1.0, 2.0), 1.0);
    EXPECT_EQ(greater(1.0, 2.0), 2.0);
}

TEST(Real, RoundToIntTakesTheEvenOfTwo) {
    EXPECT_EQ(round_to_int(2.5), 2.0);
    EXPECT_EQ(round_to_int(-3.5), -4.0);
}

TEST(Real, MultiplyWideIsTheWholeProduct) {
    test::Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const auto a = static_cast<std::uint32_t>(random.bits());
        const auto b = static_cast<std::uint32_t>(random.bits());
        std::uint32_t high, low;
        multiply_wide(a, b, high, low);
        ASSERT_EQ((std::uint64_t{high} << 32) | low, std::uint64_t{a} * b) << a << " * " << b;
    }
}

}  // namespace
}  // namespace tandem
