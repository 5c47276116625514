// Exact sums against arithmetic that is long enough.
#include "tandem/math/exact_sum.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/mpfr.hpp>

#include "support/random.h"

namespace tandem {
namespace {

using test::Random;
using Big = boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<1200>>;

/// Any magnitude down to the subnormals, up to 2^60.
template <class T>
T any_number(Random& random) {
    const int lowest = std::numeric_limits<T>::min_exponent - std::numeric_limits<T>::digits;
    if (random.below(8) == 0) return random.coin() ? T(0) : -T(0);
    const double narrow_or_wide = random.coin() ? random.uniform(-20.0, 20.0) : random.uniform(lowest * 0.999, 59.9);
    const T magnitude = static_cast<T>(std::exp2(narrow_or_wide));
    return random.coin() ? magnitude : -magnitude;
}

template <class T>
void compare_with_big() {
    for (std::uint64_t number = 0; number < 4000; ++number) {
        Random random(number);
        ExactSum<T> sum;
        Big exact = 0;
        T a[64], b[64], c[64];
        const int terms = static_cast<int>(random.below(32)) + 1;
        int used = 0;
        const auto add = [&](T x, T y, T z, bool take_away) {
            sum.add(x, y, z, take_away);
            exact += (take_away ? -1 : 1) * Big(x) * Big(y) * Big(z);
        };
        for (; used < terms; ++used) {
            a[used] = any_number<T>(random), b[used] = any_number<T>(random), c[used] = any_number<T>(random);
            add(a[used], b[used], c[used], random.coin());
        }
        // take most of it back, so that little is left
        for (int i = 0; i < used - 1 && random.coin(); ++i) add(-a[i], b[i], c[i], random.coin());
        ASSERT_EQ(sum.sign(), exact > 0 ? 1 : exact < 0 ? -1 : 0) << "case " << number;
        const ScaledPair leading = sum.leading();
        const Big value = ldexp(Big(leading.mantissa.high) + Big(leading.mantissa.low), leading.exponent);
        ASSERT_TRUE(abs(value - exact) <= ldexp(abs(exact), -100)) << "case " << number;
        ASSERT_EQ(leading.mantissa.high, leading.mantissa.high + leading.mantissa.low);
    }
}

TEST(ExactSum, OfFloatsIsExact) { compare_with_big<float>(); }
TEST(ExactSum, OfDoublesIsExact) { compare_with_big<double>(); }

TEST(ExactSum, CancelsToZeroAndToTheLastBit) {
    const float large = 0x1.fffffep59F;
    const float least = 0x1p-149F;
    ExactSum<float> sum;
    for (int i = 0; i < 20; ++i) sum.add(large, large, large);
    sum.add(least, -least, least);
    for (int i = 0; i < 20; ++i) sum.add(-large, large, large);
    EXPECT_EQ(sum.sign(), -1);
    EXPECT_EQ(sum.leading().mantissa.high, -1.0);
    EXPECT_EQ(sum.leading().exponent, -447);
    sum.add(least, least, least);
    EXPECT_EQ(sum.sign(), 0);
    EXPECT_EQ(sum.leading().mantissa.high, 0.0);
}

TEST(ExactSum, NegativePowersOfTwoCarryOutOfTheirWords) {
    for (int power = -148; power < 60; ++power) {
        ExactSum<float> sum;
        const auto factor = static_cast<float>(std::exp2(power));
        sum.add(factor, factor, factor, true);
        const ScaledPair leading = sum.leading();
        EXPECT_EQ(std::ldexp(leading.mantissa.high, leading.exponent), -std::exp2(3 * power)) << power;
        EXPECT_EQ(quotient(leading, leading), 1.0);
    }
}

TEST(ExactSum, DeterminantsHaveTheSignOfTheirTurn) {
    ExactSum<float> sum;
    add_determinant(sum, Vec3f{1, 2, 3}, Vec3f{4, 5, 6}, Vec3f{7, 8, 10});
    EXPECT_EQ(sum.leading().mantissa.high * std::exp2(sum.leading().exponent), -3.0);
    add_determinant(sum, Vec3f{1, 2, 3}, Vec3f{4, 5, 6}, Vec3f{7, 8, 10}, true);
    EXPECT_EQ(sum.sign(), 0);
}

}  // namespace
}  // namespace tandem
