/// Functions of the tier fast in float, which the exact tiers compute in double: reciprocal square root, power,
/// polynomials of angles. Only the stated errors are guaranteed, not the bits.
#pragma once

#include "tandem/math/exact_math.h"
#include "tandem/math/fast_float.h"

namespace tandem {

/// 1 / sqrt(x) for x >= 0; zero counts as the smallest normal number. Relative error 2^-22.
template <class D>
requires(is_fast<D>) TANDEM_HD_INLINE D inverse_square_root(const D& x) {
    const D positive = greater(x, D(0x1p-126F));
#if TANDEM_ON_DEVICE
    return rsqrtf(positive.v);
#else
    return D(1.0F) / square_root(positive);
#endif
}

/// a b - c d without error compensation; the exact tiers' version is in error_free.h.
template <class D>
requires(is_fast<D>) TANDEM_HD_INLINE D difference_of_products(const D& a, const D& b, const D& c, const D& d) {
    return a * b - c * d;
}

/// Nearest integer, ties to even, of |x| < 2^22.
template <class D>
requires(is_fast<D>) TANDEM_HD_INLINE D round_to_int(const D& x) { return (x + D(0x1.8p23F)) - D(0x1.8p23F); }

namespace fast_detail {

// For |r| <= pi/4 with a relative error of the polynomial below 2^-28, and for |t| <= tan(pi/8) below 2^-25.
template <class D>
TANDEM_HD_INLINE D sine(const D& r) {
    const D z = r * r;
    const D tail = (z * D(-0x1.994edcp-13F) + D(0x1.110760p-7F)) * z + D(-0x1.555546p-3F);
    return r + r * z * tail;
}
template <class D>
TANDEM_HD_INLINE D cosine(const D& r) {
    const D z = r * r;
    const D tail = (z * D(0x1.9a0222p-16F) + D(-0x1.6c0c8cp-10F)) * z + D(0x1.55554ap-5F);
    return (z * tail + D(-0.5F)) * z + D(1.0F);
}
template <class D>
TANDEM_HD_INLINE D arctangent(const D& t) {
    const D z = t * t;
    const D tail = ((z * D(0x1.4a255ap-4F) + D(-0x1.1c4246p-3F)) * z + D(0x1.9925dcp-3F)) * z + D(-0x1.555458p-2F);
    return t + t * z * tail;
}

/// log2(x) of a positive normal x, by the series of 2 atanh(s), s = f / (2 + f). Relative error 2^-22, or absolute
/// error 2^-44.
template <class Real>
TANDEM_HD_INLINE Real log2(const Real& x) {
    using Word = UInt<Real>;
    const Word sqrt_half(0x3F3504F3U);
    const Word biased = bits_of(x) + (Word(0x3F800000U) - sqrt_half);
    const Real f = Real(float_of((biased & Word(0x007FFFFFU)) + sqrt_half)) - Real(1.0F);
    const Real exponent = from_uint<Real>(biased >> 23) - Real(127.0F);
    const Real s = f / (f + Real(2.0F));
    const Real z = s * s;
    const Real series = ((z * Real(0.4121986F) + Real(0.5770780F)) * z + Real(0.9617967F)) * z + Real(2.8853901F);
    return exponent + s * series;
}

/// 2^x, x clamped to [-126, 127]. Relative error 2^-22.
template <class Real>
TANDEM_HD_INLINE Real exp2(const Real& x) {
    const Real clamped = greater(lesser(x, Real(127.0F)), Real(-126.0F));
    const Real shift(0x1.8p23F + 127.0F);
    const Real biased = clamped + shift;
    const Real t = (clamped - (biased - shift)) * Real(0.69314718F);
    Real sum = t * Real(1.0F / 720) + Real(1.0F / 120);
    sum = sum * t + Real(1.0F / 24);
    sum = sum * t + Real(1.0F / 6);
    sum = sum * t + Real(0.5F);
    sum = sum * t + Real(1.0F);
    sum = sum * t + Real(1.0F);
    return sum * Real(float_of(bits_of(biased) << 23));
}

}  // namespace fast_detail

/// e^x for x <= 88. Relative error 2^-21 (1 + |x|).
template <class Real>
requires(is_fast<Real>) TANDEM_HD_INLINE Double<Real> exponential(const Double<Real>& x) {
#if TANDEM_ON_DEVICE
    return exp2f(x.v * 1.44269504F);
#else
    return fast_detail::exp2(x * Real(1.44269504F));
#endif
}

/// x^y for x in [0, 1] and y >= 0. Relative error 2^-21 (1 + |y log2 x|). 0^0 = 1.
template <class Real>
requires(is_fast<Real>) TANDEM_HD_INLINE Double<Real> power(const Double<Real>& x, const Double<Real>& y) {
#if TANDEM_ON_DEVICE
    const Real result = exp2f(y.v * log2f(x.v));
#else
    const Real result = fast_detail::exp2(y * fast_detail::log2(x));
#endif
    return select(x > Real(0.0F), result, select(y == Real(0.0F), Real(1.0F), Real(0.0F)));
}

}  // namespace tandem
