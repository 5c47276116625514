/// y / sqrt(d) from one approximate root.
#pragma once

#include "tandem/math/fast_float.h"
#include "tandem/math/rough.h"

namespace tandem {

/// y / sqrt(d), for d in [2^-40, 2^40] and |y| <= sqrt(d).
///
/// Gives: the root correctly rounded, then the quotient correctly rounded; below 2^-80 the quotient may differ, and
///        stays below 2^-79. In the tier fast, within 2^-21 of itself.
/// Method: on a GPU, the steps that its compiler takes for a root and for a division, without their branches for other
///         ranges: with r = 1 / sqrt(d) to 2^-22, a residual corrects the root d r; one Newton step makes r the
///         reciprocal of the rounded root, within half an ulp and 2^-20 of an ulp; two residuals correct the quotient.
///         So one approximation serves both, and neighbouring calls can overlap.
/// Source: P. Markstein, "IA-64 and Elementary Functions", 2000, ch. 8 and 9.
template <class Real>
TANDEM_HD_INLINE Real over_root(const Real& y, const Real& d) {
#if TANDEM_ON_DEVICE && !defined(TANDEM_NO_LOOSE_FMA)
    if constexpr (std::is_same_v<Real, FastFloat>) {
        return y * FastFloat(rough_inverse_square_root(d.v));
    } else if constexpr (std::is_same_v<Real, float>) {
        const float r = rough_inverse_square_root(d);
        const float guess = d * r;
        const float root = fmaf(fmaf(-guess, guess, d), 0.5F * r, guess);
        const float reciprocal = fmaf(r, fmaf(-root, r, 1.0F), r);
        const float first = y * reciprocal;
        const float second = fmaf(fmaf(-root, first, y), reciprocal, first);
        return fmaf(fmaf(-root, second, y), reciprocal, second);
    }
#endif
    return y / square_root(d);
}

}  // namespace tandem
