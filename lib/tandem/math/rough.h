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

}  // namespace tandem
