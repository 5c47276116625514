/// The angle of a point: the same bits from every compiler and processor.
#pragma once

#include "tandem/math/real.h"

namespace tandem {

inline constexpr double pi = 0x1.921fb54442d18p+1;

namespace arctangent_detail {

inline constexpr double tangent_of_eighth = 0x1.a827999fcef32p-2;  ///< tan(pi / 8)

/// c[0] + c[1] z + c[2] z^2 + ..., in the operations that every tier has.
template <class D>
TANDEM_HD D polynomial(const D&, double c) {
    return constant<D>(c);
}
template <class D, class... More>
TANDEM_HD D polynomial(const D& z, double c, More... more) {
    return z * polynomial(z, more...) + constant<D>(c);
}

}  // namespace arctangent_detail

/// The angle of the point (x, y) from the x axis towards the y axis, in [-pi, pi]. `D`: a Double<Real>.
///
/// Needs: magnitudes below 2^1000 (in the tier fast below 2^120). Zeros count as positive: (-1, -0) is at pi. (0, 0) is
///        at 0. A NaN gives any number or NaN.
/// Gives: within 5e-16; in the tier fast within 1e-6.
/// Method: the smaller coordinate over the larger, turned by pi / 4 where that exceeds tan(pi / 8), so that one
///        division suffices and a polynomial of small degree does. Coefficients: tests/unit/math/minimax.py. Held by
///        tests/unit/math/arctangent_test.cpp.
template <class D>
TANDEM_HD D arctangent(const D& y, const D& x) {
    const D zero(0.0);
    const D width = absolute(x);
    const D height = absolute(y);
    const auto steep = height > width;
    const D most = select(steep, height, width);
    const D least = select(steep, width, height);
    const auto turned = least > constant<D>(arctangent_detail::tangent_of_eighth) * most;
    const D numerator = select(turned, least - most, least);
    const D denominator = select(turned, least + most, most);
    const D q = numerator / select(denominator == zero, D(1.0), denominator);
    const D z = q * q;
    const D tail = arctangent_detail::polynomial(z, -0x1.555555555553dp-2, 0x1.9999999995898p-3, -0x1.24924922aef6bp-3,
                                                 0x1.c71c70e6c0640p-4, -0x1.745cf8eb2a278p-4, 0x1.3b1119589eb88p-4,
                                                 -0x1.10ebb07af5a07p-4, 0x1.df0e5c83d849cp-5, -0x1.9ccd657f6a9f7p-5,
                                                 0x1.37c89cee589dap-5, -0x1.2556e1e8cf6c4p-6);
    D angle = (q * z) * tail + q;
    angle = select(turned, constant<D>(0.25 * pi) + angle, angle);
    angle = select(steep, constant<D>(0.5 * pi) - angle, angle);
    angle = select(x < zero, constant<D>(pi) - angle, angle);
    return select(y < zero, -angle, angle);
}

}  // namespace tandem
