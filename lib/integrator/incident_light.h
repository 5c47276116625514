/// One light as a vertex of a path receives it.
#pragma once

#include "tandem/geometry/spawn_ray.h"

namespace tandem {

template <class Real>
struct IncidentLight {
    Vec3<Real> reflected;  ///< radiance that the surface makes of it, if nothing stops it; 0 where it brings none
    Vec3<Real> to;         ///< where it comes from: a point or, if it is far, a direction
    UInt<Real> primitive = UInt<Real>(no_primitive);  ///< the light's own
    bool is_far = false;                              ///< infinitely; one light is for all lanes
    bool casts_shadows = true;
};

}  // namespace tandem
