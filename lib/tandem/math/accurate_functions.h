/// Elementary functions of double for the host: what is prepared once and reaches the film or the hash of a scene must
/// not depend on the C library, whose double functions differ between releases and between processors.
///
/// Gives:  the double nearest to the true value, but where that is within 2^-40 of a unit in the last place of the
/// middle
///         between two doubles: there it may be the other one. So any other library that is correctly rounded gives
///         the same bits, but for about one argument in 2^40. NaN gives NaN.
/// Method: pairs of doubles (math/error_free.h, 2^-100) from + - * / sqrt, fma and rounding to an integer, and one
///         rounding at the end. Correct only without contraction, as all of Tandem is compiled
///         (cmake/compile_flags.cmake). About a microsecond a call, so not for loops over pixels or texels. Kernels use
///         math/exact_math.h and math/turns.h.
/// Held by tests/math/accurate_functions_test.cpp, against MPFR.
#pragma once

namespace tandem {

/// |x| <= 2^20, radians. Beyond that NaN.
[[nodiscard]] double accurate_sin(double x);
[[nodiscard]] double accurate_cos(double x);
[[nodiscard]] double accurate_tan(double x);

/// Radians, from -pi/2 to pi/2. Every x.
[[nodiscard]] double accurate_atan(double x);

/// Radians, from 0 to pi. |x| <= 1; beyond that NaN.
[[nodiscard]] double accurate_acos(double x);

/// Every x. Of a cube it is exact.
[[nodiscard]] double accurate_cbrt(double x);

/// The natural logarithm. -infinity at 0 and NaN below.
[[nodiscard]] double accurate_log(double x);

}  // namespace tandem
