/// Reciprocal square root and power of the tier fast, in float. No bits are promised, only the errors given.
#pragma once

#include "tandem/math/exact_math.h"
#include "tandem/math/fast_float.h"

namespace tandem {

/// 1 / sqrt(x) for x >= 0; zero counts as the smallest normal number. Relative error 2^-22.
template <class D>
requires(is_fast<D>) TANDEM_HD D inverse_square_root(const D& x) {
    const D positive = greater(x, D(0x1p-126F));
#if TANDEM_ON_DEVICE
    return rsqrtf(positive.v);
#else
    return D(1.0F) / square_root(positive);
#endif
}

namespace fast_detail {

/// log2(x) of a positive normal x within 2^-22 of its magnitude or of 2^-22, by the series of 2 atanh(s), s = f / (2 +
/// f).
template <class Real>
TANDEM_HD Real log2(const Real& x) {
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
TANDEM_HD Real exp2(const Real& x) {
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

/// x^y for x in [0, 1] and y >= 0. Relative error 2^-21 (1 + |y log2 x|). 0^0 = 1.
template <class Real>
requires(is_fast<Real>) TANDEM_HD Double<Real> power(const Double<Real>& x, const Double<Real>& y) {
#if TANDEM_ON_DEVICE
    const Real result = exp2f(y.v * log2f(x.v));
#else
    const Real result = fast_detail::exp2(y * fast_detail::log2(x));
#endif
    return select(x > Real(0.0F), result, select(y == Real(0.0F), Real(1.0F), Real(0.0F)));
}

}  // namespace tandem
