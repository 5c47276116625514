/// One light as a vertex of a path receives it.
#pragma once

#include "tandem/geometry/spawn_ray.h"

namespace tandem {

template <class Real>
struct IncidentLight {
    Vec3<Real> reflected;  ///< radiance that the surface makes of it, if nothing stops it; 0 where it brings none
    Vec3<Real> to;         ///< where it comes from: a point or, if it is far, a direction
    UInt<Real> primitive = UInt<Real>(no_primitive);  ///< the light's own
    Mask<Real> is_far = Mask<Real>(false);            ///< infinitely
    Mask<Real> casts_shadows = Mask<Real>(true);

    /// `a` in the lanes of `mask`, else `b`.
    TANDEM_HD friend IncidentLight select(const Mask<Real>& mask, const IncidentLight& a, const IncidentLight& b) {
        return {select(mask, a.reflected, b.reflected), select(mask, a.to, b.to),
                select(mask, a.primitive, b.primitive), select(mask, a.is_far, b.is_far),
                select(mask, a.casts_shadows, b.casts_shadows)};
    }
};

}  // namespace tandem
