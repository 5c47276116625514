/// Transcendental functions: the same bits from every compiler and processor.
///
/// exact_sin, exact_cos, exact_exp, exact_log, exact_pow   float to float, correctly rounded (to nearest, ties to even)
///     for every input, so that every other correctly rounded library agrees. The libraries of the CPU and of CUDA are
///     neither correctly rounded nor equal. sin, cos, exp and log are compared with MPFR over all floats by
///     tests/unit/math/exhaustive_math.cpp; for pow see there.
/// log_wide, exp_wide, power   double to double, within a few units of the last place, for use inside a formula.
///
/// NaN in gives the quiet NaN 0x7FC00000 out of the float functions. Coefficients: tests/unit/math/minimax.py.
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

/// Adding this to a double of magnitude below 2^51 rounds it to an integer, which then stands in the low bits.
inline constexpr double to_low_bits = 0x1.8p52;

/// c[0] + c[1] x + c[2] x^2 + ...
template <class D>
TANDEM_HD D horner(const D&, double c) {
    return D(c);
}
template <class D, class... More>
TANDEM_HD D horner(const D& x, double c, More... more) {
    return multiply_add(x, horner(x, more...), D(c));
}

template <class Real>
TANDEM_HD Float<Real> quiet_nan() {
    return Float<Real>(float_of(0x7FC00000U));
}

/// x = (1 + f) 2^exponent with 1 + f in [sqrt(1/2), sqrt(2)), x a positive normal double; f is exact.
template <class Real>
TANDEM_HD void reduce_log(const Double<Real>& x, Double<Real>& f, Double<Real>& exponent) {
    using D = Double<Real>;
    using I = Int64<Real>;
    const I sqrt_half(0x3FE6A09E667F3BCD);
    const I biased = bits_of(x) + (I(0x3FF0000000000000) - sqrt_half);  // exponent + 1023, then the bits of 1 + f
    f = double_of((biased & I(0x000FFFFFFFFFFFFF)) + sqrt_half) - D(1.0);
    exponent = double_of(shift_right_logical(biased, 52) | I(0x4330000000000000)) - D(0x1p52 + 1023);
}

/// log(1 + f) = f - f^2/2 + this, within 2^-57: with s = f / (2 + f) it is s (f^2/2 + 2 atanh(s)/s - 2).
template <class D>
TANDEM_HD D log_tail(const D& f, const D& half_square) {
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
TANDEM_HD void reduce_exp(const Double<Real>& x, Double<Real>& r, Double<Real>& r_low, Double<Real>& scale) {
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
TANDEM_HD D exp_even_tail(const D& z) {
    return horner(z, 0x1.5555555555558p-5, 0x1.6c16c16c14ffap-10, 0x1.a01a01ad81059p-16, 0x1.27e4cc08ffd29p-22,
                  0x1.1f8bef3e8ae32p-29);
}
template <class D>
TANDEM_HD D exp_odd_tail(const D& z) {
    return horner(z, 0x1.555555555555cp-3, 0x1.111111110e969p-7, 0x1.a01a01b49fd74p-13, 0x1.71dded5035d80p-19,
                  0x1.af70d0a72f6fbp-26);
}

}  // namespace exact_detail

/// log(x) for x in (0, inf), normal. Relative error below 2^-52, also next to 1.
template <class Real>
TANDEM_HD Double<Real> log_wide(const Double<Real>& x) {
    using D = Double<Real>;
    D f, exponent;
    exact_detail::reduce_log<Real>(x, f, exponent);
    const D half_square = f * (f * D(0.5));
    const D tail = multiply_add(exponent, D(exact_detail::ln2_low), exact_detail::log_tail(f, half_square));
    return multiply_add(exponent, D(exact_detail::ln2_high), f - (half_square - tail));
}

/// exp(x), x clamped to [-700, 700], where float has long under- or overflowed. Relative error below 2^-52.
template <class Real>
TANDEM_HD Double<Real> exp_wide(const Double<Real>& x) {
    using D = Double<Real>;
    D r, r_low, scale;
    exact_detail::reduce_exp<Real>(greater(lesser(x, D(700.0)), D(-700.0)), r, r_low, scale);
    const D z = r * r;
    const D even = multiply_add(z, exact_detail::exp_even_tail(z), D(0.5));
    const D higher = multiply_add(r, exact_detail::exp_odd_tail(z), even);
    return (D(1.0) + multiply_add(z, higher, r)) * scale;
}

/// x^y for x in [0, inf), normal or zero, and y >= 0. Relative error below 2^-52 (1 + |y log x|): the error of the
/// logarithm counts y times. 0^0 = 1.
template <class Real>
TANDEM_HD Double<Real> power(const Double<Real>& x, const Double<Real>& y) {
    using D = Double<Real>;
    const D result = exp_wide<Real>(y * log_wide<Real>(x));
    return select(x > D(0.0), result, select(y == D(0.0), D(1.0), x));  // the last x: zero or NaN
}

/// e^x for every float.
template <class Real>
TANDEM_HD Real exact_exp(const Real& x) {
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
TANDEM_HD Real exact_log(const Real& x) {
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

}  // namespace tandem
