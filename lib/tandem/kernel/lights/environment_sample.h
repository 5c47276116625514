/// A sampled direction of an environment, and the radiance along a direction.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// A direction that is sampled in proportion to the brightness of an environment, or nearly so.
template <class Real>
struct EnvironmentSample {
    Vec3<Double<Real>> direction;  ///< unit, towards the environment
    Vec3<Real> radiance;           ///< RGB, as seen there
    Double<Real> pdf;              ///< with respect to solid angle, 1/sr; 0 for a black environment
};

/// The radiance along a direction, and its density as an EnvironmentSample.
template <class Real>
struct EnvironmentSight {
    Vec3<Real> radiance;
    Double<Real> pdf;
};

}  // namespace tandem
