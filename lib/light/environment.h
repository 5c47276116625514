/// What a ray sees that hits nothing, and the ambient light that Phong materials receive.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// A vertical gradient: (1 - m) bottom + m top, m = (y + 1) / 2 with y of the unit direction. RGB, linear.
struct Environment {
    Vec3f bottom{1.0F, 1.0F, 1.0F};
    Vec3f top{0.5F, 0.7F, 1.0F};
    Vec3f ambient{1.0F, 1.0F, 1.0F};  ///< ia of Phong's model
};

/// Radiance along a direction of any length but zero; double inside, so that no length over- or underflows.
template <class Real>
TANDEM_HD Vec3<Real> background(const Environment& environment, const Vec3<Real>& direction) {
    using D = Double<Real>;
    const Vec3<D> d = widen(direction);
    const D height = d.y / square_root(dot(d, d));
    const Real m = narrow((height + D(1.0)) * D(0.5));
    return broadcast<Real>(environment.bottom) * (Real(1.0F) - m) + broadcast<Real>(environment.top) * m;
}

}  // namespace tandem
