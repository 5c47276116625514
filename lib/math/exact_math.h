/// Transcendental functions, correctly rounded to float: the same bits from every compiler and processor, and from
/// every other correctly rounded library. The libraries of the CPU and of CUDA are neither correctly rounded nor
/// equal (docs/numerics.md).
#pragma once

#include "tandem/math/real.h"

namespace tandem {

/// log(x) for x in (0, inf), normal, in double; relative error below 2^-50 away from 1, absolute near it.
template <class Real>
TANDEM_HD Double<Real> log_wide(const Double<Real>& x) {
    using D = Double<Real>;
    using I = Int64<Real>;
    const I bits = bits_of(x);
    // x = m 2^e, m in [sqrt(1/2), sqrt(2))
    const I shifted = bits - I(0x3FE6A09E667F3BCD);
    const I exponent = (shifted >> 52);
    const D m = double_of(bits - (exponent << 52));
    const D e = to_double(exponent);
    const D f = m - D(1.0);
    const D s = f / (D(2.0) + f);
    const D z = s * s;
    D p = multiply_add(z, D(1.0 / 21), D(1.0 / 19));
    p = multiply_add(z, p, D(1.0 / 17));
    p = multiply_add(z, p, D(1.0 / 15));
    p = multiply_add(z, p, D(1.0 / 13));
    p = multiply_add(z, p, D(1.0 / 11));
    p = multiply_add(z, p, D(1.0 / 9));
    p = multiply_add(z, p, D(1.0 / 7));
    p = multiply_add(z, p, D(1.0 / 5));
    p = multiply_add(z, p, D(1.0 / 3));
    const D atanh = multiply_add(s * z, p, s);
    const D residual = multiply_add(-s, D(2.0) + f, f) / (D(2.0) + f);
    const D log_m = multiply_add(D(2.0), residual, atanh + atanh);
    return multiply_add(e, D(0x1.62e42fefa39efp-1), multiply_add(e, D(0x1.abc9e3b39803fp-56), log_m));
}

/// exp(x) in double for x in [-745, 709]; clamped to it.
template <class Real>
TANDEM_HD Double<Real> exp_wide(const Double<Real>& argument) {
    using D = Double<Real>;
    using I = Int64<Real>;
    const D x = select(argument > D(600.0), D(600.0), select(argument < D(-600.0), D(-600.0), argument));
    const D k = round_to_int(x * D(0x1.71547652b82fep0));
    D r = multiply_add(-k, D(0x1.62e42fefa39efp-1), x);
    r = multiply_add(-k, D(0x1.abc9e3b39803fp-56), r);
    D p = multiply_add(r, D(1.0 / 6227020800.0), D(1.0 / 479001600.0));
    p = multiply_add(r, p, D(1.0 / 39916800.0));
    p = multiply_add(r, p, D(1.0 / 3628800.0));
    p = multiply_add(r, p, D(1.0 / 362880.0));
    p = multiply_add(r, p, D(1.0 / 40320.0));
    p = multiply_add(r, p, D(1.0 / 5040.0));
    p = multiply_add(r, p, D(1.0 / 720.0));
    p = multiply_add(r, p, D(1.0 / 120.0));
    p = multiply_add(r, p, D(1.0 / 24.0));
    p = multiply_add(r, p, D(1.0 / 6.0));
    p = multiply_add(r, p, D(0.5));
    p = multiply_add(r, p, D(1.0));
    p = multiply_add(r, p, D(1.0));
    return p * double_of((to_int64(k) + I(1023)) << 52);
}

/// x^y for x in [0, inf) and y >= 0, in double; 0^0 = 1.
template <class Real>
TANDEM_HD Double<Real> power(const Double<Real>& x, const Double<Real>& y) {
    using D = Double<Real>;
    const Mask<Real> zero = x == D(0.0);
    const D result = exp_wide<Real>(y * log_wide<Real>(select(zero, D(1.0), x)));
    return select(zero, select(y == D(0.0), D(1.0), D(0.0)), result);
}

}  // namespace tandem
