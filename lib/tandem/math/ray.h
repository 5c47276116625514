/// Rays, and which of them every backend accepts.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// Points origin + t * direction for t > 0. World space, metres. The direction need not be a unit vector; t counts
/// in its lengths.
template <class Real>
struct Ray {
    Vec3<Real> origin;
    Vec3<Real> direction;
};

/// A caller's ray as the kernels of a tier take it; exact.
template <class Real>
TANDEM_HD Ray<Real> to_real(const Ray<float>& ray) {
    return {broadcast<Real>(ray.origin), broadcast<Real>(ray.direction)};
}

/// Largest magnitude of a coordinate in a scene or a ray. Embree aborts beyond 1.8e18 and drops primitives there.
inline constexpr float coordinate_limit = 1e18F;

/// True for rays that may be traced: finite, coordinates within coordinate_limit, direction not zero. All others
/// are a miss on every backend. (NaN fails every comparison.)
template <class Real>
TANDEM_HD Mask<Real> is_traceable(const Ray<Real>& ray) {
    const auto within = [](const Real& a) { return absolute(a) <= Real(coordinate_limit); };
    return within(ray.origin.x) && within(ray.origin.y) && within(ray.origin.z) && within(ray.direction.x) &&
           within(ray.direction.y) && within(ray.direction.z) && norm1(ray.direction) > Real(0);
}

}  // namespace tandem
