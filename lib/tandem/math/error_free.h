/// Sums and products without rounding error: a value as a pair high + low of doubles, and the one rounding of such
/// a pair to float. Exact as long as nothing over- or underflows.
/// Source: T. J. Dekker, "A floating-point technique for extending the available precision", Numer. Math. 18, 1971.
#pragma once

#include "tandem/math/real.h"

namespace tandem {

/// high + low, unevaluated; |low| <= ulp(high) / 2 unless said otherwise.
template <class D>
struct Pair {
    D high;
    D low;
};

/// a + b exactly; needs |a| >= |b| or a = 0.
template <class D>
TANDEM_HD_INLINE Pair<D> fast_two_sum(const D& a, const D& b) {
    const D sum = a + b;
    return {sum, b - (sum - a)};
}

/// a + b exactly.
template <class D>
TANDEM_HD_INLINE Pair<D> two_sum(const D& a, const D& b) {
    const D sum = a + b;
    const D from_b = sum - a;
    return {sum, (a - (sum - from_b)) + (b - from_b)};
}

/// a * b exactly.
template <class D>
TANDEM_HD_INLINE Pair<D> two_product(const D& a, const D& b) {
    const D product = a * b;
    return {product, multiply_add(a, b, -product)};
}

/// a b - c d within 1.5 ulp.
/// Source: W. Kahan; error bound by C.-P. Jeannerod, N. Louvet, J.-M. Muller, "Further analysis of Kahan's algorithm
/// for the accurate computation of 2x2 determinants", Math. Comp. 82, 2013.
template <class D>
TANDEM_HD_INLINE D difference_of_products(const D& a, const D& b, const D& c, const D& d) {
    const D cd = c * d;
    const D error = multiply_add(c, d, -cd);
    return multiply_add(a, b, -cd) - error;
}

// The relative error of these is below 2^-103, even if a sum cancels.
// Source: M. Joldes, J.-M. Muller, V. Popescu, "Tight and rigorous error bounds for basic building blocks of
// double-word arithmetic", ACM TOMS 44(2), 2017: AccurateDWPlusDW, DWTimesDW2.

template <class D>
TANDEM_HD_INLINE Pair<D> operator+(const Pair<D>& a, const Pair<D>& b) {
    const Pair<D> high = two_sum(a.high, b.high);
    const Pair<D> low = two_sum(a.low, b.low);
    const Pair<D> sum = fast_two_sum(high.high, high.low + low.high);
    return fast_two_sum(sum.high, sum.low + low.low);
}
template <class D>
TANDEM_HD_INLINE Pair<D> operator*(const Pair<D>& a, const Pair<D>& b) {
    const Pair<D> product = two_product(a.high, b.high);
    return fast_two_sum(product.high, multiply_add(a.high, b.low, multiply_add(a.low, b.high, product.low)));
}

template <class D>
TANDEM_HD_INLINE Pair<D> operator-(const Pair<D>& a) {
    return {-a.high, -a.low};
}
template <class D>
TANDEM_HD_INLINE Pair<D> operator-(const Pair<D>& a, const Pair<D>& b) {
    return a + -b;
}
/// a / n for an integer n.
template <class D>
TANDEM_HD_INLINE Pair<D> divide(const Pair<D>& a, double n) {
    const D high = a.high / D(n);
    return fast_two_sum(high, (multiply_add(-high, D(n), a.high) + a.low) / D(n));
}

/// a / b for b != 0, rounded to the nearest double unless the quotient is within 2^-48 ulp of the midpoint between two.
template <class D>
TANDEM_HD_INLINE D quotient(const Pair<D>& a, const Pair<D>& b) {
    const D inverse = D(1.0) / b.high;
    const D first = a.high * inverse;
    const D rest = multiply_add(-first, b.high, a.high) + multiply_add(-first, b.low, a.low);
    return multiply_add(rest, inverse, first);
}

/// The float nearest to high + low, |high| >= |low| or high = 0, low of any size below that; the sum need not be a
/// pair in the strict sense.
///
/// Rounding the sum to double first would round twice: the double may be the midpoint of two floats that the sum is
/// only near to. So it is rounded to odd: if the sum is not a double, to the neighbour with an odd last bit, which is
/// never such a midpoint. Source: S. Boldo, G. Melquiond, "Emulation of FMA and correctly rounded sums: proved
/// algorithms using rounding to odd", IEEE Trans. Comput. 57(4), 2008.
template <class Real>
TANDEM_HD_INLINE Float<Real> round_once(const Double<Real>& high, const Double<Real>& low) {
    using D = Double<Real>;
    using I = UInt64<Real>;
    const Pair<D> sum = fast_two_sum(high, low);
    const I bits = bits_of(sum.high);
    const I if_even = (bits & I(1)) - I(1);
    // the double farther from zero has the larger bit pattern: +1 if the signs of the parts agree, else -1
    const I step = I(1) - (((bits ^ bits_of(sum.low)) >> 63) << 1);
    return narrow(double_of(bits + select(sum.low == D(0.0), I(0), step & if_even)));
}

}  // namespace tandem
