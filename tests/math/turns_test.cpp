// Sine, cosine and arctangent in turns against MPFR.
#include "tandem/math/turns.h"

#include <gtest/gtest.h>

#include <boost/math/constants/constants.hpp>

#include "support/exact_geometry.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::Big;

Big big_pi() { return boost::math::constants::pi<Big>(); }

/// |value - exact| in units of 2^-53 of exact.
double error_of(double value, const Big& exact) {
    if (exact == 0) return value == 0 ? 0 : HUGE_VAL;
    return static_cast<double>(Big(abs((Big(value) - exact) / exact))) * 0x1p53;
}

TEST(Turns, SineAndCosineAreWithinTheirBound) {
    const auto expect_at = [](double u, const std::string& name) {
        const SineCosine<double> found = sin_cos_turns<double>(u);
        const Big angle = 2 * big_pi() * Big(u);
        // near a zero of the exact value u itself is exact, so the bound is relative there too
        const bool sine_zero = std::fmod(u, 0.5) == 0;
        const bool cosine_zero = std::fmod(u, 0.5) == 0.25;
        EXPECT_LE(sine_zero ? std::abs(found.sine) : error_of(found.sine, sin(angle)), sine_zero ? 0 : 2.0) << name;
        EXPECT_LE(cosine_zero ? std::abs(found.cosine) : error_of(found.cosine, cos(angle)), cosine_zero ? 0 : 2.0)
            << name;
    };
    for (int i = 0; i <= 64; ++i) {
        for (const double off : {0.0, 0x1p-53, -0x1p-53, 0x1p-30}) {
            const double u = i / 64.0 + off;
            expect_at(u, "u = " + std::to_string(i) + " / 64 + " + std::to_string(off));
        }
    }
    for (std::uint64_t number = 0; number < 3'000; ++number) {
        test::Random random(number);
        expect_at(random.coin() ? random.uniform(0.0, 1.0) : std::abs(static_cast<double>(random.log_uniform(-60, 0))),
                  "case " + std::to_string(number));
        ASSERT_FALSE(::testing::Test::HasFailure());
    }
}

TEST(Turns, AreExactAtQuarters) {
    for (int i = -8; i <= 8; ++i) {
        const SineCosine<float> found = sin_cos_turns<float>(i / 4.0);
        const int quadrant = (i + 8) % 4;
        EXPECT_EQ(found.sine, quadrant == 1 ? 1 : quadrant == 3 ? -1 : 0) << i;
        EXPECT_EQ(found.cosine, quadrant == 0 ? 1 : quadrant == 2 ? -1 : 0) << i;
    }
}

TEST(Turns, ArctangentIsWithinItsBound) {
    for (std::uint64_t number = 0; number < 3'000; ++number) {
        test::Random random(number);
        const auto coordinate = [&] {
            return random.coin() ? random.uniform(-1.0, 1.0) : static_cast<double>(random.log_uniform(-50, 50));
        };
        const double x = coordinate();
        const double y = coordinate();
        const Big exact = atan2(Big(y), Big(x)) / (2 * big_pi());
        ASSERT_LE(error_of(atan2_turns<double>(y, x), exact), 8.0) << "case " << number << ": " << y << ", " << x;
    }
    EXPECT_EQ(atan2_turns<double>(0, 0), 0);
    EXPECT_EQ(atan2_turns<double>(0, -2), 0.5);
    EXPECT_EQ(atan2_turns<double>(3, 0), 0.25);
    EXPECT_EQ(atan2_turns<double>(-3, 0), -0.25);
    EXPECT_EQ(atan2_turns<double>(-1, -1), -0.375);
}

TEST(Turns, InTheTierFastTheyAreWithinTheirBounds) {
    for (std::uint64_t number = 0; number < 100'000; ++number) {
        test::Random random(number);
        const float u = random.uniform(0.0F, 1.0F);
        const SineCosine<FastFloat> found = sin_cos_turns<FastFloat>(u);
        const SineCosine<double> wanted = sin_cos_turns<double>(static_cast<double>(u));
        ASSERT_NEAR(to_wide(found.sine), wanted.sine, 0x1p-22) << "case " << number;
        ASSERT_NEAR(to_wide(found.cosine), wanted.cosine, 0x1p-22) << "case " << number;
        const float x = random.log_uniform(-20, 20);
        const float y = random.log_uniform(-20, 20);
        const double turns = atan2_turns<double>(static_cast<double>(y), static_cast<double>(x));
        ASSERT_NEAR(to_wide(atan2_turns<FastFloat>(y, x)), turns, std::abs(turns) * 0x1p-21) << "case " << number;
    }
}

}  // namespace
}  // namespace tandem
