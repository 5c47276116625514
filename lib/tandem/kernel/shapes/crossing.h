/// The crossings of a line with a convex solid.
#pragma once

#include "tandem/math/real.h"

namespace tandem {

/// Entry and exit parameters along a ray, in double. Valid where `crosses`; then t_near <= t_far.
template <class Real>
struct Crossing {
    Mask<Real> crosses;
    Double<Real> t_near;
    Double<Real> t_far;
};

/// The first crossing in front of the origin: t_near if positive, else t_far if positive (origin inside), else a
/// miss. `t` is written in every lane and is valid where the result is true.
template <class Real>
TANDEM_HD_INLINE Mask<Real> first_hit(const Crossing<Real>& c, Double<Real>& t) {
    const Double<Real> zero(0.0);
    t = select(c.t_near > zero, c.t_near, c.t_far);
    return c.crosses && t > zero;
}

}  // namespace tandem
