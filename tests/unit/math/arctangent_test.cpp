// The angle of a point against the C library's in long double, whose own error is below 1e-18.
#include "tandem/math/arctangent.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/random.h"
#include "tandem/math/fast_float.h"

namespace tandem {
namespace {

long double error_at(double y, double x) {
    const long double right = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    return std::abs(static_cast<long double>(arctangent(y, x)) - right);
}

TEST(Arctangent, IsWithinItsBoundAllAround) {
    for (std::uint64_t number = 0; number < 1'000'000; ++number) {
        test::Random random(number);
        const double y = random.uniform(-1.0, 1.0);
        const double x = random.uniform(-1.0, 1.0);
        ASSERT_LT(error_at(y, x), 5e-16L) << "case " << number << ": y " << y << ", x " << x;
    }
}

TEST(Arctangent, IsWithinItsBoundForCoordinatesOfAnySize) {
    for (std::uint64_t number = 0; number < 200'000; ++number) {
        test::Random random(number);
        const auto any = [&] {
            return std::ldexp(random.uniform(-1.0, 1.0), static_cast<int>(random.below(2000)) - 1000);
        };
        const double y = any();
        const double x = any();
        ASSERT_LT(error_at(y, x), 5e-16L) << "case " << number << ": y " << y << ", x " << x;
    }
}

// Where the method changes its way: at 22.5 and 45 degrees, and next to the axes.
TEST(Arctangent, IsWithinItsBoundNextToItsBorders) {
    for (const double slope : {arctangent_detail::tangent_of_eighth, 1.0, 0x1p-60, 0x1p60}) {
        double x = slope;
        for (int step = 0; step < 10; ++step) {
            for (const double sign : {1.0, -1.0}) {
                ASSERT_LT(error_at(1, sign * x), 5e-16L) << slope << ", step " << step;
                ASSERT_LT(error_at(sign * x, 1), 5e-16L) << slope << ", step " << step;
            }
            x = std::nextafter(x, step % 2 == 0 ? 0 : 10);
        }
    }
}

TEST(Arctangent, KnowsTheAxesAndTheirOrigin) {
    EXPECT_EQ(arctangent(0.0, 0.0), 0);
    EXPECT_EQ(arctangent(-0.0, 1.0), 0);
    EXPECT_EQ(arctangent(0.0, -1.0), pi);
    EXPECT_EQ(arctangent(-0.0, -1.0), pi) << "zeros have no sign";
    EXPECT_EQ(arctangent(1.0, 0.0), pi / 2);
    EXPECT_EQ(arctangent(-1.0, 0.0), -pi / 2);
    EXPECT_EQ(pi, std::acos(-1.0));
}

TEST(Arctangent, IsWithinAMillionthInTheTierFast) {
    for (std::uint64_t number = 0; number < 100'000; ++number) {
        test::Random random(number);
        const float y = random.uniform(-1.0F, 1.0F);
        const float x = random.uniform(-1.0F, 1.0F);
        ASSERT_NEAR(arctangent(FastFloat(y), FastFloat(x)).v, std::atan2(y, x), 1e-6) << "case " << number;
    }
}

}  // namespace
}  // namespace tandem
