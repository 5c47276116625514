#include "tandem/math/error_free.h"

#include <gtest/gtest.h>
#include <mpfr.h>

#include "support/random.h"

namespace tandem {
namespace {

/// a + b (or a * b) in MPFR, minus high, minus low; zero if the pair is exact.
double remainder(double a, double b, bool product, const Pair<double>& pair) {
    mpfr_t value, other;
    mpfr_inits2(3000, value, other, static_cast<mpfr_ptr>(nullptr));
    mpfr_set_d(value, a, MPFR_RNDN);
    mpfr_set_d(other, b, MPFR_RNDN);
    if (product) {
        mpfr_mul(value, value, other, MPFR_RNDN);
    } else {
        mpfr_add(value, value, other, MPFR_RNDN);
    }
    mpfr_sub_d(value, value, pair.high, MPFR_RNDN);
    mpfr_sub_d(value, value, pair.low, MPFR_RNDN);
    const double rest = mpfr_get_d(value, MPFR_RNDA);
    mpfr_clears(value, other, static_cast<mpfr_ptr>(nullptr));
    return rest;
}

double any_double(test::Random& random) {
    const double magnitude = std::exp2(random.uniform(-200.0, 200.0));
    return random.coin() ? magnitude : -magnitude;
}

TEST(ErrorFree, SumsAndProductsAreExact) {
    test::Random random(3);
    for (int i = 0; i < 20000; ++i) {
        const double a = any_double(random);
        const double b = random.coin() ? any_double(random) : -a * random.uniform(0.5, 2.0);
        ASSERT_EQ(remainder(a, b, false, two_sum(a, b)), 0) << std::hexfloat << a << " " << b;
        ASSERT_EQ(remainder(a, b, true, two_product(a, b)), 0) << std::hexfloat << a << " " << b;
        const double large = std::abs(a) > std::abs(b) ? a : b;
        const double small = std::abs(a) > std::abs(b) ? b : a;
        ASSERT_EQ(remainder(a, b, false, fast_two_sum(large, small)), 0) << std::hexfloat << a << " " << b;
    }
}

// A double on the midpoint of two floats, and a low part that decides.
TEST(ErrorFree, RoundOnceDoesNotRoundTwice) {
    const double midpoint = 1.0 + 0x1p-24;
    EXPECT_EQ(round_once<float>(midpoint, 0.0), 1.0F);
    EXPECT_EQ(round_once<float>(midpoint, 0x1p-100), 1.0F + 0x1p-23F);
    EXPECT_EQ(round_once<float>(midpoint, -0x1p-100), 1.0F);
    EXPECT_EQ(round_once<float>(-midpoint, -0x1p-100), -1.0F - 0x1p-23F);
    EXPECT_EQ(round_once<float>(-midpoint, 0x1p-100), -1.0F);
    const double odd = 1.0F + 0x1p-23 + 0x1p-24;  // its even neighbour lies above
    EXPECT_EQ(round_once<float>(odd, -0x1p-100), 1.0F + 0x1p-23F);
    EXPECT_EQ(round_once<float>(odd, 0.0), 1.0F + 0x1p-22F);
    // halfway between zero and the least subnormal float
    EXPECT_EQ(round_once<float>(0x1p-150, 0.0), 0.0F);
    EXPECT_EQ(round_once<float>(0x1p-150, 0x1p-300), 0x1p-149F);
    EXPECT_EQ(round_once<float>(0x1p-150, -0x1p-300), 0.0F);
    EXPECT_TRUE(std::signbit(round_once<float>(-0.0, -0.0)));
}

}  // namespace
}  // namespace tandem
