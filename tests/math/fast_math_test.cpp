// The float functions of the tier fast, against double. Its bits are not promised; its errors are bounded.

#include "tandem/math/fast_math.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"
#include "tandem/math/vec.h"

namespace tandem {
namespace {

TEST(FastMath, PowerIsWithinItsBound) {
    for (int i = 0; i <= 1000; ++i) {
        for (const double exponent : {0.0, 1e-3, 0.5, 1.0, 5.0, 32.0, 1000.0, 1e5}) {
            const double base = i / 1000.0;
            const float x = static_cast<float>(base);
            const double exact = std::pow(static_cast<double>(x), exponent);
            const double value = to_wide(power<FastFloat>(x, exponent));
            const double growth = x > 0 ? 1 + std::abs(exponent * std::log2(static_cast<double>(x))) : 1;
            // results below the normal numbers of float may vanish
            EXPECT_NEAR(value, exact, exact * growth * 0x1p-21 + 0x1p-125) << base << " ^ " << exponent;
        }
    }
    EXPECT_EQ(to_plain(power<FastFloat>(0.0F, 0.0F)), 1.0F);
    EXPECT_EQ(to_plain(power<FastFloat>(0.0F, 3.0F)), 0.0F);
    EXPECT_EQ(to_plain(power<FastFloat>(1.0F, 1e8F)), 1.0F);
}

TEST(FastMath, InverseSquareRootIsWithinItsBound) {
    for (double x = 1e-35; x < 1e38; x *= 1.37) {
        const FastFloat root = inverse_square_root(FastFloat(x));
        EXPECT_NEAR(to_wide(root) * std::sqrt(static_cast<double>(static_cast<float>(x))), 1.0, 0x1p-22) << x;
    }
    EXPECT_TRUE(std::isfinite(to_plain(inverse_square_root(FastFloat(0)))));
    const Vec3<FastFloat> zero = normalize(Vec3<FastFloat>{0, 0, 0});
    EXPECT_EQ(to_plain(zero.x), 0.0F);
}

}  // namespace
}  // namespace tandem
