/// Approximate functions for bounds whose margins cover their error. As with loose_multiply_add(), results may differ
/// between processors, so nothing that decides a bit of the image may depend on them. With TANDEM_NO_LOOSE_FMA they are
/// exact: tests/lint uses it to check that nothing else is approximate.
#pragma once

#include "tandem/math/real.h"

namespace tandem {

/// 1 / a within 2^-22 of itself, for 2^-126 <= |a| <= 2^126.
TANDEM_HD_INLINE float rough_reciprocal(float a) {
#if TANDEM_ON_DEVICE && !defined(TANDEM_NO_LOOSE_FMA)
    float result;
    asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(result) : "f"(a));
    return result;
#else
    return 1.0F / a;
#endif
}

template <class F>
requires(RealTraits<F>::lanes > 1) TANDEM_HD_INLINE F rough_reciprocal(const F& a) { return F(1.0F) / a; }

/// 1 / sqrt(a) within 2^-22 of itself, for a >= 2^-126.
TANDEM_HD_INLINE float rough_inverse_square_root(float a) {
#if TANDEM_ON_DEVICE && !defined(TANDEM_NO_LOOSE_FMA)
    float result;
    asm("rsqrt.approx.ftz.f32 %0, %1;" : "=f"(result) : "f"(a));
    return result;
#else
    return 1.0F / square_root(a);
#endif
}

/// lesser() and greater(), except for the sign of a zero, where `a` is no NaN: a single instruction on a GPU.
TANDEM_HD_INLINE float rough_lesser(float a, float b) {
#if TANDEM_ON_DEVICE && !defined(TANDEM_NO_LOOSE_FMA)
    float result;
    asm("min.f32 %0, %1, %2;" : "=f"(result) : "f"(a), "f"(b));
    return result;
#else
    return lesser(a, b);
#endif
}
TANDEM_HD_INLINE float rough_greater(float a, float b) {
#if TANDEM_ON_DEVICE && !defined(TANDEM_NO_LOOSE_FMA)
    float result;
    asm("max.f32 %0, %1, %2;" : "=f"(result) : "f"(a), "f"(b));
    return result;
#else
    return greater(a, b);
#endif
}
template <class F>
requires(RealTraits<F>::lanes > 1) TANDEM_HD_INLINE F rough_greater(const F& a, const F& b) { return greater(a, b); }

/// 1 / a and 1 / sqrt(a) within 3 * 2^-53 of themselves, for a in [2^-500, 2^500]: a guess within 2^-18, and a step of
/// third order, whose error is that of the guess cubed. The bits differ between processors.
TANDEM_HD_INLINE double close_reciprocal(double a) {
#if TANDEM_ON_DEVICE && !defined(TANDEM_NO_LOOSE_FMA)
    double guess;
    asm("rcp.approx.ftz.f64 %0, %1;" : "=d"(guess) : "d"(a));
    const double error = multiply_add(-a, guess, 1.0);
    return multiply_add(guess, multiply_add(error, error, error), guess);
#else
    return 1.0 / a;
#endif
}
TANDEM_HD_INLINE double close_inverse_square_root(double a) {
#if TANDEM_ON_DEVICE && !defined(TANDEM_NO_LOOSE_FMA)
    double guess;
    asm("rsqrt.approx.ftz.f64 %0, %1;" : "=d"(guess) : "d"(a));
    const double error = multiply_add(-(a * guess), guess, 1.0);
    return multiply_add(guess * error, multiply_add(error, 0.375, 0.5), guess);
#else
    return 1.0 / square_root(a);
#endif
}

}  // namespace tandem
