// exact_math.h against MPFR. exhaustive_math.cpp does the same for every float; here a fixed subset.
#include "tandem/math/exact_math.h"

#include <gtest/gtest.h>

#include <limits>

#include "math/pow_pairs.h"
#include "support/correct_rounding.h"

namespace tandem {
namespace {

using test::agrees;
using test::CorrectRounding;
using test::Function;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Inputs that are hard to round or to reduce: those on which simpler double evaluations of these functions fail, those
/// that the exhaustive test found nearest to a midpoint, zeros and poles, ends of ranges, and large multiples of pi/2.
const float hard_inputs[] = {
    // simple double evaluations fail on these
    0x1.33333p13F, 0x1.827a74p-7F, 0x1.2f1fd6p3F, 0x1.bacb4ap25F, 0x1.b121a6p76F, 0x1.6351d8p95F,
#include "math/hard_inputs.def"
    // next to a multiple of pi/2 after a large reduction; the largest float
    0x1.f9cbe2p7F, 0x1.921fb6p0F, 0x1.921fb4p1F, 0x1.6ac5b2p2F, 0x1.f37b7p119F, 0x1.f37e84p79F, 0x1.d768b4p27F, 0x1p20F,
    0x1.000002p20F, 0x1.fffffep19F, 0x1.fffffep127F,
    // ends of the range of exp
    0x1.62e42ep6F, 0x1.62e43p6F, -0x1.9fe36ap6F, -0x1.9fe368p6F, -0x1.5d589ep6F, -0x1.5d58ap6F, 100.0F, -110.0F,
    // small and special
    0.0F, 0x1p-149F, 0x1.fffffcp-127F, 0x1p-126F, 0x1p-25F, 0x1p-24F, 0x1.fffffep-1F, 1.0F, 0x1.000002p0F, infinity};

class ExactMath : public testing::TestWithParam<Function> {};

TEST_P(ExactMath, IsCorrectlyRounded) {
    const Function& function = GetParam();
    CorrectRounding reference(function);
    const bool is_pow = std::string(function.name) == "pow";
    const auto check = [&](float x, float y) {
        const float want = reference(x, y);
        const float ours = function.ours(x, y);
        ASSERT_TRUE(agrees(ours, want)) << std::hexfloat << function.name << "(" << x << ", " << y << ") is " << want
                                        << ", not " << ours;
    };
    for (const float x : hard_inputs) {
        for (const float y : hard_inputs) {
            check(x, y);
            check(-x, y);
            if (!is_pow) break;
            check(x, -y);
            check(-x, -y);
        }
        if (HasFatalFailure()) return;
    }
    constexpr std::uint32_t count = (1U << 20) + 1;
    for (std::uint32_t i = 0; i < count && !HasFatalFailure(); ++i) {
        const auto [x, y] = is_pow ? test::pow_pair(i) : std::pair{float_of(i * 4093U), 0.0F};
        check(x, y);
    }
}

INSTANTIATE_TEST_SUITE_P(All, ExactMath, testing::ValuesIn(test::functions),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(ExactMath, SignedZerosAndInfinities) {
    EXPECT_TRUE(std::signbit(exact_sin(-0.0F)));
    EXPECT_FALSE(std::signbit(exact_sin(0.0F)));
    EXPECT_EQ(bits_of(exact_sin(infinity)), 0x7FC00000U);
    EXPECT_EQ(bits_of(exact_cos(-infinity)), 0x7FC00000U);
    EXPECT_EQ(exact_exp(-infinity), 0.0F);
    EXPECT_EQ(exact_exp(infinity), infinity);
    EXPECT_EQ(exact_log(0.0F), -infinity);
    EXPECT_EQ(exact_log(-0.0F), -infinity);
    EXPECT_EQ(exact_log(infinity), infinity);
    EXPECT_EQ(bits_of(exact_log(-1.0F)), 0x7FC00000U);
    EXPECT_FALSE(std::signbit(exact_log(1.0F)));
}

// IEEE 754-2019, 9.2.1.
TEST(ExactMath, PowTakesTheSpecialValuesOfTheStandard) {
    EXPECT_EQ(exact_pow(nan, 0.0F), 1.0F);
    EXPECT_EQ(exact_pow(1.0F, nan), 1.0F);
    EXPECT_EQ(exact_pow(-1.0F, infinity), 1.0F);
    EXPECT_EQ(exact_pow(-1.0F, 3.0F), -1.0F);
    EXPECT_EQ(bits_of(exact_pow(nan, 1.0F)), 0x7FC00000U);
    EXPECT_EQ(bits_of(exact_pow(2.0F, nan)), 0x7FC00000U);
    EXPECT_EQ(bits_of(exact_pow(-2.0F, 0.5F)), 0x7FC00000U);
    EXPECT_EQ(exact_pow(-2.0F, 3.0F), -8.0F);
    EXPECT_EQ(exact_pow(-2.0F, -2.0F), 0.25F);
    EXPECT_EQ(exact_pow(0.0F, -1.0F), infinity);
    EXPECT_EQ(exact_pow(-0.0F, -1.0F), -infinity);
    EXPECT_EQ(exact_pow(-0.0F, -2.0F), infinity);
    EXPECT_TRUE(std::signbit(exact_pow(-0.0F, 3.0F)));
    EXPECT_FALSE(std::signbit(exact_pow(-0.0F, 2.5F)));
    EXPECT_EQ(exact_pow(0.5F, infinity), 0.0F);
    EXPECT_EQ(exact_pow(0.5F, -infinity), infinity);
    EXPECT_EQ(exact_pow(-infinity, 3.0F), -infinity);
    EXPECT_EQ(exact_pow(-infinity, 0.5F), infinity);
    EXPECT_TRUE(std::signbit(exact_pow(-infinity, -3.0F)));
    EXPECT_EQ(exact_pow(0x1p-75F, 2.0F), 0.0F);  // halfway to the least float: to even
    EXPECT_EQ(exact_pow(0x1.8p-50F, 3.0F), 0x1.bp-149F);
}

/// Relative error of `value` against the function of x and y in MPFR, in units of 2^-52.
double error_of(const Function& function, double x, double y, double value) {
    mpfr_t first, second, exact;
    mpfr_inits2(200, first, second, exact, static_cast<mpfr_ptr>(nullptr));
    mpfr_set_d(first, x, MPFR_RNDN);
    mpfr_set_d(second, y, MPFR_RNDN);
    function.mpfr(exact, first, second);
    mpfr_set_d(first, value, MPFR_RNDN);
    mpfr_sub(first, first, exact, MPFR_RNDN);
    mpfr_div(first, first, exact, MPFR_RNDN);
    const double error = std::abs(mpfr_get_d(first, MPFR_RNDN)) * 0x1p52;
    mpfr_clears(first, second, exact, static_cast<mpfr_ptr>(nullptr));
    return error;
}

TEST(ExactMath, WideFunctionsHoldTheirBounds) {
    const Function& exp_reference = test::functions[2];
    const Function& log_reference = test::functions[3];
    const Function& pow_reference = test::functions[4];
    test::Random random(4);
    for (int i = 0; i < 20000; ++i) {
        const double any = std::exp2(random.uniform(-1000.0, 1000.0));
        ASSERT_LE(error_of(log_reference, any, 0, log_wide<float>(any)), 1.0) << std::hexfloat << any;
        const double near_one = 1.0 + random.uniform(-0.5, 0.5) * std::exp2(random.uniform(-50.0, 0.0));
        if (near_one != 1.0) {
            ASSERT_LE(error_of(log_reference, near_one, 0, log_wide<float>(near_one)), 1.0)
                << std::hexfloat << near_one;
        }
        const double x = random.uniform(-700.0, 700.0);
        ASSERT_LE(error_of(exp_reference, x, 0, exp_wide<float>(x)), 1.0) << std::hexfloat << x;
        const double base = 1.0 - random.uniform(0.0, 1.0) * std::exp2(random.uniform(-30.0, 0.0));
        const double exponent = std::exp2(random.uniform(-10.0, 27.0));
        const double logarithm = std::abs(exponent * std::log(base));
        if (base <= 0 || logarithm > 690) continue;
        ASSERT_LE(error_of(pow_reference, base, exponent, power<float>(base, exponent)), 1.0 + logarithm)
            << std::hexfloat << base << " ^ " << exponent;
    }
}

TEST(ExactMath, PowerAtTheEdges) {
    EXPECT_EQ(power<float>(0.0, 0.0), 1.0);
    EXPECT_EQ(power<float>(0.0, 1e-30), 0.0);
    EXPECT_EQ(power<float>(1.0, 1e8), 1.0);
    EXPECT_EQ(power<float>(0.5, 0.0), 1.0);
    EXPECT_NEAR(power<float>(0.5, 3.0), 0.125, 0x1p-53);
    EXPECT_EQ(narrow(power<float>(0.5, 1e8)), 0.0F);
    EXPECT_TRUE(std::isnan(power<float>(static_cast<double>(nan), 2.0)));
}

}  // namespace
}  // namespace tandem
