// The host's elementary functions of double against MPFR: equal to the correctly rounded value.
#include "tandem/math/accurate_functions.h"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <cfenv>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "support/random.h"
#include "tandem/math/real.h"

namespace tandem {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A function as we and MPFR have it, and the arguments that it is tried with: magnitudes from 2^least to 2^most, and
/// no larger than `largest`.
struct Function {
    const char* name;
    double (*ours)(double);
    int (*mpfr)(mpfr_t, mpfr_srcptr, mpfr_rnd_t);
    double least, most, largest;
    bool takes_negative;
};

const Function functions[] = {
    {"sin", accurate_sin, mpfr_sin, -40, 20, 0x1p20, true},
    {"cos", accurate_cos, mpfr_cos, -40, 20, 0x1p20, true},
    {"tan", accurate_tan, mpfr_tan, -40, 20, 0x1p20, true},
    {"atan", accurate_atan, mpfr_atan, -60, 60, infinity, true},
    {"acos", accurate_acos, mpfr_acos, -60, 0, 1, true},
    {"cbrt", accurate_cbrt, mpfr_cbrt, -1074, 1024, infinity, true},
    {"log", accurate_log, mpfr_log, -1074, 1024, infinity, false},
};

class AccurateFunctions : public ::testing::TestWithParam<Function> {
  protected:
    AccurateFunctions() { mpfr_init2(exact_, 53); }
    ~AccurateFunctions() override { mpfr_clear(exact_); }
    AccurateFunctions(const AccurateFunctions&) = delete;
    AccurateFunctions& operator=(const AccurateFunctions&) = delete;

    /// The correctly rounded value; for results that are normal numbers.
    double reference(double x) {
        mpfr_t argument;
        mpfr_init2(argument, 53);
        mpfr_set_d(argument, x, MPFR_RNDN);
        GetParam().mpfr(exact_, argument, MPFR_RNDN);
        mpfr_clear(argument);
        return mpfr_get_d(exact_, MPFR_RNDN);
    }

    void expect_rounded(double x) {
        const double wanted = reference(x), found = GetParam().ours(x);
        if (std::isnan(wanted) && std::isnan(found)) return;
        ASSERT_EQ(bits_of(found), bits_of(wanted))
            << std::hexfloat << "accurate_" << GetParam().name << "(" << x << ") is " << found << ", not " << wanted;
    }

    mpfr_t exact_;
};

TEST_P(AccurateFunctions, AreCorrectlyRounded) {
    const Function& f = GetParam();
    for (std::uint64_t number = 0; number < 20'000; ++number) {
        test::Random random(number);
        // not exp2 of the exponent: all bits are to be random
        const double fraction = random.uniform(1.0, 2.0);
        const double magnitude = random.coin() ? std::ldexp(fraction, static_cast<int>(random.uniform(f.least, f.most)))
                                               : random.uniform(0.0, std::fmin(f.largest, 8.0));
        if (magnitude > f.largest || magnitude == 0) continue;
        expect_rounded(f.takes_negative && random.coin() ? -magnitude : magnitude);
        if (HasFatalFailure()) FAIL() << "case " << number;
    }
}

TEST_P(AccurateFunctions, AreCorrectlyRoundedNextToWhatIsSpecial) {
    const Function& f = GetParam();
    std::vector<double> centres = {0, 1e-300, 0x1p-27, 0.25, 0.5, 1, 2, 8, 27, 1e15, 0x1p20};
    for (int i = 1; i <= 512; ++i) {  // multiples of pi/4, for which what is left of the argument is tiny
        centres.push_back(i * 0x1.921fb54442d18p-1);
        centres.push_back(i * 1297.0 * 0x1.921fb54442d18p-1);
    }
    for (int i = 1; i <= 64; ++i) centres.push_back(i / 64.0);
    for (const double centre : centres) {
        double above = centre, below = centre;
        for (int step = 0; step < 8; ++step) {
            for (const double x : {above, below}) {
                if (!(std::abs(x) <= f.largest) || (!f.takes_negative && x <= 0)) continue;
                expect_rounded(x);
                if (f.takes_negative && x != 0) expect_rounded(-x);
                if (HasFatalFailure()) return;
            }
            above = std::nextafter(above, infinity);
            below = std::nextafter(below, -infinity);
        }
    }
}

TEST_P(AccurateFunctions, DoNotDependOnTheRoundingOfTheCaller) {
    const Function& f = GetParam();
    for (std::uint64_t number = 0; number < 200; ++number) {
        const double x = test::Random(number).uniform(0.001, std::fmin(f.largest, 8.0));
        const double wanted = reference(x);
        std::fesetround(FE_UPWARD);
        const double found = f.ours(x);
        std::fesetround(FE_TONEAREST);
        ASSERT_EQ(bits_of(found), bits_of(wanted)) << std::hexfloat << "accurate_" << f.name << "(" << x << ")";
    }
}

INSTANTIATE_TEST_SUITE_P(Each, AccurateFunctions, ::testing::ValuesIn(functions),
                         [](const auto& info) { return info.param.name; });

TEST(AccurateFunctionsAt, Ends) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Function& f : functions) EXPECT_TRUE(std::isnan(f.ours(nan))) << f.name;
    for (const double x : {infinity, -infinity, 0x1.0000000000001p20}) {
        EXPECT_TRUE(std::isnan(accurate_sin(x)) && std::isnan(accurate_cos(x)) && std::isnan(accurate_tan(x))) << x;
        EXPECT_TRUE(std::isnan(accurate_acos(x))) << x;
    }
    EXPECT_EQ(accurate_atan(infinity), 0x1.921fb54442d18p+0);
    EXPECT_EQ(accurate_atan(-infinity), -0x1.921fb54442d18p+0);
    EXPECT_EQ(accurate_cbrt(infinity), infinity);
    EXPECT_EQ(accurate_cbrt(-infinity), -infinity);
    EXPECT_EQ(accurate_log(infinity), infinity);
    EXPECT_EQ(accurate_log(0), -infinity);
    EXPECT_TRUE(std::isnan(accurate_log(-1)));
    for (double (*const f)(double) : {accurate_sin, accurate_tan, accurate_atan, accurate_cbrt}) {
        EXPECT_EQ(bits_of(f(-0.0)), bits_of(-0.0));
    }
}

TEST(AccurateFunctionsAt, Cubes) {
    for (int i = 1; i < 2000; ++i) EXPECT_EQ(accurate_cbrt(double(i) * i * i), i);
}

}  // namespace
}  // namespace tandem
