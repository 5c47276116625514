/// Elementary functions of double for the host. Values that are prepared once and reach the film or the hash of a scene
/// must not depend on the C library, whose functions differ between releases and between processors.
///
/// Gives:  the double nearest to the exact value, unless that is within 2^-40 ulp of the midpoint between two doubles:
///         then it may be the other one. So every correctly rounded library gives the same bits, except for about one
///         argument in 2^40. NaN gives NaN.
/// Method: pairs of doubles (math/error_free.h, 2^-100) from + - * / sqrt, fma and rounding to an integer, and one
///         rounding at the end. Correct only without contraction (cmake/compile_flags.cmake). A call takes about a
///         microsecond: too slow for loops over pixels or texels. Kernels use math/exact_math.h and math/turns.h.
/// Tested by tests/math/accurate_functions_test.cpp, against MPFR.
#pragma once

namespace tandem {

/// Radians, |x| <= 2^20; NaN beyond.
[[nodiscard]] double accurate_sin(double x);
[[nodiscard]] double accurate_cos(double x);
[[nodiscard]] double accurate_tan(double x);

/// Radians, from -pi/2 to pi/2, for every x.
[[nodiscard]] double accurate_atan(double x);

/// Radians, from 0 to pi, for |x| <= 1; NaN beyond.
[[nodiscard]] double accurate_acos(double x);

/// For every x. Exact for cubes.
[[nodiscard]] double accurate_cbrt(double x);

/// The natural logarithm; -infinity at 0, NaN below.
[[nodiscard]] double accurate_log(double x);

}  // namespace tandem
