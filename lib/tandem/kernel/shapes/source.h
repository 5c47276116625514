/// The surface that a ray leaves.
#pragma once

#include "tandem/kernel/shapes/hit.h"

namespace tandem {

/// The source of a ray. no_primitive for a ray that does not start on a surface.
template <class Real>
struct Source {
    UInt<Real> primitive = UInt<Real>(no_primitive);
    Mask<Real> inside = Mask<Real>(false);  ///< it leaves inward: direction . outward normal < 0
};
using RaySource = Source<float>;

}  // namespace tandem
