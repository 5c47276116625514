#include "tandem/math/inverse_square_root.h"

#include <gtest/gtest.h>
#include <mpfr.h>

#include "support/random.h"

namespace tandem {
namespace {

/// |inverse_square_root(x) - 1 / sqrt(x)| in units of the last place of the result.
double error_of(double x) {
    mpfr_t exact;
    mpfr_init2(exact, 200);
    mpfr_set_d(exact, x, MPFR_RNDN);
    mpfr_rec_sqrt(exact, exact, MPFR_RNDN);
    const double ours = inverse_square_root(x);
    const double ulp = std::nextafter(ours, HUGE_VAL) - ours;
    mpfr_sub_d(exact, exact, ours, MPFR_RNDN);
    const double error = std::abs(mpfr_get_d(exact, MPFR_RNDN)) / ulp;
    mpfr_clear(exact);
    return error;
}

TEST(InverseSquareRoot, IsWithinTwoUnitsOfTheLastPlace) {
    test::Random random(10);
    for (int i = 0; i < 200000; ++i) {
        // two octaves cover the function, the others its exponents
        const double x = i % 2 == 0 ? random.uniform(1.0, 4.0) : std::exp2(random.uniform(-1021.9, 1023.9));
        ASSERT_LE(error_of(x), 2.0) << std::hexfloat << x;
    }
    for (const double x :
         {0x1p-1022, 1.0, std::nextafter(1.0, 0.0), std::nextafter(4.0, 0.0), 4.0, 0x1.fffffffffffffp1023}) {
        ASSERT_LE(error_of(x), 2.0) << std::hexfloat << x;
    }
}

TEST(InverseSquareRoot, OfZeroIsFinite) {
    EXPECT_TRUE(std::isfinite(inverse_square_root(0.0)));
    EXPECT_TRUE(std::isnan(inverse_square_root(std::nan(""))));
}

}  // namespace
}  // namespace tandem
