/// Transcendental functions: the same bits from every compiler and processor.
///
/// exact_sin, exact_cos, exact_exp, exact_log, exact_pow   float to float, correctly rounded (to nearest, ties to even)
///     for every input, so that every other correctly rounded library agrees. The libraries of the CPU and of CUDA are
///     neither correctly rounded nor equal. sin, cos, exp and log are compared with MPFR over all floats by
///     tests/math/exhaustive_math.cpp; for pow see there.
/// log_wide, exp_wide, power   double to double, within a few units of the last place, for use inside a formula.
///
/// NaN in gives the quiet NaN 0x7FC00000 out of the float functions. Coefficients: tests/math/minimax.py.
#pragma once

#include "tandem/math/error_free.h"

namespace tandem {

namespace exact_detail {

inline constexpr double ln2_high = 0x1.62e42fefa39efp-1;
inline constexpr double ln2_low = 0x1.abc9e3b39803fp-56;
inline constexpr double log2_e = 0x1.71547652b82fep+0;
inline constexpr double half_pi_high = 0x1.921fb54442d18p+0;
inline constexpr double half_pi_low = 0x1.1a62633145c07p-54;
inline constexpr double two_over_pi = 0x1.45f306dc9c883p-1;
inline constexpr double infinity = __builtin_huge_val();

/// Adding this to a double of magnitude below 2^51 rounds it to an integer, which is then in the low bits.
inline constexpr double to_low_bits = 0x1.8p52;

/// c[0] + c[1] x + c[2] x^2 + ...
template <class D>
TANDEM_HD_INLINE D horner(const D&, double c) {
    return D(c);
}
template <class D, class... More>
TANDEM_HD_INLINE D horner(const D& x, double c, More... more) {
    return multiply_add(x, horner(x, more...), D(c));
}

template <class Real>
TANDEM_HD_INLINE Float<Real> quiet_nan() {
    return Float<Real>(float_of(0x7FC00000U));
}

/// x = (1 + f) 2^exponent with 1 + f in [sqrt(1/2), sqrt(2)), x a positive normal double; f is exact.
template <class Real>
TANDEM_HD_INLINE void reduce_log(const Double<Real>& x, Double<Real>& f, Double<Real>& exponent) {
    using D = Double<Real>;
    using I = UInt64<Real>;
    const I sqrt_half(0x3FE6A09E667F3BCD);
    const I biased = bits_of(x) + (I(0x3FF0000000000000) - sqrt_half);  // exponent + 1023, then the bits of 1 + f
    f = double_of((biased & I(0x000FFFFFFFFFFFFF)) + sqrt_half) - D(1.0);
    exponent = double_of((biased >> 52) | I(0x4330000000000000)) - D(0x1p52 + 1023);
}

/// log(1 + f) = f - f^2/2 + this, within 2^-57: with s = f / (2 + f) it is s (f^2/2 + 2 atanh(s)/s - 2).
template <class D>
TANDEM_HD_INLINE D log_tail(const D& f, const D& half_square) {
    const D s = f / (D(2.0) + f);
    const D z = s * s;
    const D w = z * z;
    const D even = horner(w, 0x1.5555555555592p-1, 0x1.24924941e1eccp-2, 0x1.74663d223a6bfp-3, 0x1.2f03ff4e680b9p-3);
    const D odd = horner(w, 0x1.999999997ff16p-2, 0x1.c71c521389cadp-3, 0x1.39a1e293564b6p-3);
    return s * multiply_add(z, multiply_add(z, odd, even), half_square);
}

/// x = k ln 2 + r + r_low with |r| <= ln(2)/2, and scale = 2^k. For float x, r + r_low is exact to 2^-100.
/// Needs |x| <= 700 or NaN, which makes r NaN.
template <class Real>
TANDEM_HD_INLINE void reduce_exp(const Double<Real>& x, Double<Real>& r, Double<Real>& r_low, Double<Real>& scale) {
    using D = Double<Real>;
    const D shift(to_low_bits + 1023);
    const D biased = multiply_add(x, D(log2_e), shift);
    const D k = biased - shift;
    const D first = multiply_add(-k, D(ln2_high), x);
    r = multiply_add(-k, D(ln2_low), first);
    r_low = multiply_add(-k, D(ln2_low), first - r);
    scale = double_of(bits_of(biased) << 52);
}

// e^r = 1 + r + z/2 + z (z even_tail(z) + r odd_tail(z)), z = r^2: the rest of cosh and of sinh, within 2^-63 e^r.
template <class D>
TANDEM_HD_INLINE D exp_even_tail(const D& z) {
    return horner(z, 0x1.5555555555558p-5, 0x1.6c16c16c14ffap-10, 0x1.a01a01ad81059p-16, 0x1.27e4cc08ffd29p-22,
                  0x1.1f8bef3e8ae32p-29);
}
template <class D>
TANDEM_HD_INLINE D exp_odd_tail(const D& z) {
    return horner(z, 0x1.555555555555cp-3, 0x1.111111110e969p-7, 0x1.a01a01b49fd74p-13, 0x1.71dded5035d80p-19,
                  0x1.af70d0a72f6fbp-26);
}

/// x = q pi/2 + r + r_low with |r| <= pi/4; `quadrant` has q mod 4 in its low bits. x >= 0.
///
/// Up to 2^20 in three steps of which the first is exact, after W. Cody and W. Waite; error below 2^-87. Beyond it
/// x 2/pi is formed modulo 4 from slices of 2/pi: 24 by 29 bits make an exact product, and slices that give multiples
/// of 4 vanish, so that no table is indexed by x (M. Payne, R. Hanek, 1983, without the indexing); error below 2^-90.
template <class Real>
TANDEM_HD_INLINE void reduce_trig(const Double<Real>& x, UInt64<Real>& quadrant, Double<Real>& r, Double<Real>& r_low) {
    using D = Double<Real>;
    const D shift(to_low_bits);
    const D near = multiply_add(x, D(two_over_pi), shift);
    const D k = near - shift;
    const D first = multiply_add(-k, D(half_pi_high), x);
    r = multiply_add(-k, D(half_pi_low), first);
    r_low = multiply_add(-k, D(half_pi_low), first - r);
    quadrant = bits_of(near);

    const Mask<Real> large = x > D(0x1p20);
    if (!any(large)) return;
    D turns(0.0);  // of a quarter; the low part collects what the sum rounds off
    D turns_low(0.0);
    constexpr double slices[] = {0x1.45f306dp-1,   0x1.9391054p-30, 0x1.4fe13abp-59,  0x1.d1f534dp-88,
                                 0x1.b81b6c5p-117, 0x1.5993c4p-148, 0x1.c820ff2p-175, 0x1.163abdep-204};
    for (const double slice : slices) {
        const D product = x * D(slice);
        const D rest = multiply_add(D(-4.0), round_to_int(product * D(0.25)), product);
        const Pair<D> sum = two_sum(turns, rest);
        turns = sum.high;
        turns_low = turns_low + sum.low;
    }
    const D far = turns + shift;
    const Pair<D> fraction = fast_two_sum(turns - (far - shift), turns_low);
    const Pair<D> angle = two_product(fraction.high, D(half_pi_high));
    const D angle_low = multiply_add(fraction.high, D(half_pi_low), fraction.low * D(half_pi_high));
    r = select(large, angle.high, r);
    r_low = select(large, angle.low + angle_low, r_low);
    quadrant = select(large, bits_of(far), quadrant);
}

/// sin(r + r_low), for |r| <= pi/4.
template <class D>
TANDEM_HD_INLINE Pair<D> sine(const D& r, const D& r_low) {
    const D z = r * r;
    const D tail = horner(z, -0x1.5555555555555p-3, 0x1.1111111111067p-7, -0x1.a01a019ffdba6p-13, 0x1.71de3a32aa3f0p-19,
                          -0x1.ae642acdfddaap-26, 0x1.6108a372a8db1p-33, -0x1.9f61e6f4de8a1p-41);
    return {r, multiply_add(r * z, tail, multiply_add(D(-0.5) * z, r_low, r_low))};
}

/// cos(r + r_low), for |r| <= pi/4.
template <class D>
TANDEM_HD_INLINE Pair<D> cosine(const D& r, const D& r_low) {
    const Pair<D> square = two_product(r, r);
    const D z = square.high;
    const D tail = horner(z, 0x1.5555555555555p-5, -0x1.6c16c16c16b2ap-10, 0x1.a01a019ffb54bp-16,
                          -0x1.27e4fb58371c6p-22, 0x1.1eed6d038f433p-29, -0x1.93713af026d2cp-37, 0x1.9c3307f1eed9ep-45);
    const Pair<D> sum = fast_two_sum(D(1.0), D(-0.5) * z);
    const D correction = multiply_add(D(-0.5), square.low, -(r * r_low));
    return {sum.high, sum.low + multiply_add(z * z, tail, correction)};
}

/// sin(x + turns pi/2); infinity gives NaN.
template <class Real>
TANDEM_HD_INLINE Real sine_of_turned(const Real& x, const UInt64<Real>& sign_of_x, std::uint64_t turns) {
    using D = Double<Real>;
    using I = UInt64<Real>;
    D r, r_low;
    I quadrant;
    reduce_trig<Real>(absolute(widen(x)), quadrant, r, r_low);
    quadrant = quadrant + I(turns);
    const Mask<Real> odd = (quadrant & I(1)) == I(1);
    const Pair<D> s = sine(r, r_low);
    const Pair<D> c = cosine(r, r_low);
    const I sign = ((quadrant & I(2)) << 62) ^ sign_of_x;
    const D high = double_of(bits_of(select(odd, c.high, s.high)) ^ sign);
    const D low = double_of(bits_of(select(odd, c.low, s.low)) ^ sign);
    const Mask<Real> finite = absolute(x) < narrow(D(infinity));
    return select(finite, round_once<Real>(high, low), quiet_nan<Real>());
}

/// log(x) for a positive float, widened, to 2^-102 relative: 2 atanh(s) by its series.
template <class Real>
TANDEM_HD_INLINE Pair<Double<Real>> log_pair(const Double<Real>& x) {
    using D = Double<Real>;
    D f, exponent;
    reduce_log<Real>(x, f, exponent);
    const D divisor = D(2.0) + f;  // exact for a float
    const D quotient = f / divisor;
    const Pair<D> s = fast_two_sum(quotient, multiply_add(-quotient, divisor, f) / divisor);
    const Pair<D> z = s * s;
    const Pair<D> two = {D(2.0), D(0.0)};
    Pair<D> sum = divide(two, 45.0);
    for (double n = 43.0; n > 0.0; n -= 2.0) sum = divide(two, n) + z * sum;
    const Pair<D> ln2 = {D(ln2_high), D(ln2_low)};
    return Pair<D>{exponent, D(0.0)} * ln2 + s * sum;
}

/// exp(x) for |x| <= 700 to 2^-102 + 2^-103 |x| relative, divided by `scale`, a power of two.
template <class Real>
TANDEM_HD_INLINE Pair<Double<Real>> exp_pair(const Pair<Double<Real>>& x, Double<Real>& scale) {
    using D = Double<Real>;
    D first, first_low;
    reduce_exp<Real>(x.high, first, first_low, scale);
    const D shift(to_low_bits + 1023);
    const D k = multiply_add(x.high, D(log2_e), shift) - shift;
    const Pair<D> ln2 = {D(ln2_high), D(ln2_low)};
    const Pair<D> r = x + Pair<D>{-k, D(0.0)} * ln2;
    const Pair<D> one = {D(1.0), D(0.0)};
    Pair<D> sum = one;
    for (double n = 25.0; n > 0.0; n -= 1.0) sum = one + divide(r * sum, n);
    return sum;
}

}  // namespace exact_detail

/// log(x) for x in (0, inf), normal. Relative error below 2^-52, also next to 1.
template <class Real>
TANDEM_HD_INLINE Double<Real> log_wide(const Double<Real>& x) {
    using D = Double<Real>;
    D f, exponent;
    exact_detail::reduce_log<Real>(x, f, exponent);
    const D half_square = f * (f * D(0.5));
    const D tail = multiply_add(exponent, D(exact_detail::ln2_low), exact_detail::log_tail(f, half_square));
    return multiply_add(exponent, D(exact_detail::ln2_high), f - (half_square - tail));
}

/// exp(x), x clamped to [-700, 700], where float has long under- or overflowed. Relative error below 2^-52.
template <class Real>
TANDEM_HD_INLINE Double<Real> exp_wide(const Double<Real>& x) {
    using D = Double<Real>;
    D r, r_low, scale;
    exact_detail::reduce_exp<Real>(greater(lesser(x, D(700.0)), D(-700.0)), r, r_low, scale);
    const D z = r * r;
    const D even = multiply_add(z, exact_detail::exp_even_tail(z), D(0.5));
    const D higher = multiply_add(r, exact_detail::exp_odd_tail(z), even);
    return (D(1.0) + multiply_add(z, higher, r)) * scale;
}

/// e^x in the Real's type of decisions, x clamped as in exp_wide().
template <class Real>
requires(!is_fast<Real>) TANDEM_HD_INLINE Double<Real> exponential(const Double<Real>& x) { return exp_wide<Real>(x); }

/// x^y for x in [0, inf), normal or zero, and y >= 0. Relative error below 2^-52 (1 + |y log x|): y multiplies the
/// error of the logarithm. 0^0 = 1.
template <class Real>
requires(!is_fast<Real>) TANDEM_HD_INLINE Double<Real> power(const Double<Real>& x, const Double<Real>& y) {
    using D = Double<Real>;
    const D result = exp_wide<Real>(y * log_wide<Real>(x));
    return select(x > D(0.0), result, select(y == D(0.0), D(1.0), x));  // the last x: zero or NaN
}

/// e^x for every float.
template <class Real>
TANDEM_HD_INLINE Real exact_exp(const Real& x) {
    using D = Double<Real>;
    // beyond these the result is 0 or infinity
    const D clamped = widen(greater(lesser(x, Real(100.0F)), Real(-110.0F)));
    D r, r_low, scale;
    exact_detail::reduce_exp<Real>(clamped, r, r_low, scale);
    const Pair<D> square = two_product(r, r);
    const D even = square.high * exact_detail::exp_even_tail(square.high);
    const D tail = square.high * multiply_add(r, exact_detail::exp_odd_tail(square.high), even);
    const Pair<D> linear = fast_two_sum(D(1.0), r);
    const Pair<D> quadratic = fast_two_sum(linear.high, D(0.5) * square.high);
    const D correction = multiply_add(r, r_low, multiply_add(D(0.5), square.low, r_low));
    const D low = (linear.low + quadratic.low) + (tail + correction);
    const Real result = round_once<Real>(quadratic.high * scale, low * scale);
    return select(x == x, result, exact_detail::quiet_nan<Real>());
}

/// log(x) for every float: -inf at zero, NaN below.
template <class Real>
TANDEM_HD_INLINE Real exact_log(const Real& x) {
    using D = Double<Real>;
    const D infinity(exact_detail::infinity);
    D f, exponent;
    exact_detail::reduce_log<Real>(widen(x), f, exponent);
    const Pair<D> square = two_product(f, D(0.5) * f);
    const D tail = exact_detail::log_tail(f, square.high);
    const Pair<D> scale = two_product(exponent, D(exact_detail::ln2_high));
    const Pair<D> linear = fast_two_sum(scale.high, f);
    const Pair<D> quadratic = fast_two_sum(linear.high, -square.high);
    const D correction = multiply_add(exponent, D(exact_detail::ln2_low), scale.low) - square.low;
    const Real result = round_once<Real>(quadratic.high, (linear.low + quadratic.low) + (tail + correction));
    const Real edge = select(x == Real(0.0F), narrow(-infinity), exact_detail::quiet_nan<Real>());
    return select(x > Real(0.0F), select(x == narrow(infinity), x, result), edge);
}

/// sin(x) for every float; NaN for infinities.
template <class Real>
TANDEM_HD_INLINE Real exact_sin(const Real& x) {
    using I = UInt64<Real>;
    return exact_detail::sine_of_turned(x, bits_of(widen(x)) & (I(1) << 63), 0);
}

/// cos(x) for every float; NaN for infinities.
template <class Real>
TANDEM_HD_INLINE Real exact_cos(const Real& x) {
    return exact_detail::sine_of_turned(x, UInt64<Real>(0), 1);
}

/// x^y for all pairs of floats, with the special values of IEEE 754's pow: 1 for y = 0 and for x = 1, even with NaN;
/// for x < 0 NaN unless y is an integer, whose parity gives the sign, also of zeros and infinities.
///
/// A value that power() cannot round with certainty, about one in 2^17, is computed again to about 2^-95. Results that
/// are floats or midpoints of floats are recognised: a value within 2^-93 of one is assumed to be it. No other pair is
/// known whose result comes so near; among the 2^62 pairs with a finite result one would be expected with a probability
/// of a few per cent, and it would be rounded wrongly with a probability of one half.
template <class Real>
TANDEM_HD_INLINE Real exact_pow(const Real& x, const Real& y) {
    using D = Double<Real>;
    using Word = UInt<Real>;
    const D infinity(exact_detail::infinity);
    const D zero(0.0);
    const D base = absolute(widen(x));
    const D exponent = widen(y);
    const D finite_log = log_wide<Real>(base);
    const D log_base = select(base == zero, -infinity, select(base == infinity, infinity, finite_log));
    const D value = exp_wide<Real>(exponent * log_base);
    const D error = value * D(0x1p-42);
    Real magnitude = narrow(value);
    const Mask<Real> doubtful = narrow(value - error) < narrow(value + error);
    if (any(doubtful)) [[unlikely]] {
        const Pair<D> log_x = exact_detail::log_pair<Real>(base);
        D scale;
        const Pair<D> result = exact_detail::exp_pair<Real>(Pair<D>{exponent, zero} * log_x, scale);
        const Mask<Real> exact = absolute(result.low) < D(0x1p-93) * result.high;
        const D low = select(exact, zero, result.low);
        magnitude = select(doubtful, round_once<Real>(result.high * scale, low * scale), magnitude);
    }
    const Mask<Real> is_one = y == Real(0.0F) || base == D(1.0);
    magnitude = select(is_one, Real(1.0F), magnitude);

    const D half = exponent * D(0.5);
    const Mask<Real> integer = round_to_int(exponent) == exponent;
    const Mask<Real> odd = integer && round_to_int(half) != half;
    const Word sign = select(odd, bits_of(x) & Word(0x80000000U), Word(0U));
    const Real result = float_of(bits_of(magnitude) | sign);
    const Mask<Real> negative = x < Real(0.0F) && x > narrow(-infinity);
    const Mask<Real> defined = x == x && y == y && (!negative || integer);
    const Mask<Real> always_one = y == Real(0.0F) || x == Real(1.0F);
    return select(always_one, Real(1.0F), select(defined, result, exact_detail::quiet_nan<Real>()));
}

}  // namespace tandem
