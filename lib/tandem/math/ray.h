/// Rays, and which of them are traceable.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// The points origin + t * direction for t > 0, in metres. The direction need not be a unit vector; t is in lengths of
/// it.
template <class Real>
struct Ray {
    Vec3<Real> origin;
    Vec3<Real> direction;
};

/// A caller's ray in the precision of a tier's kernels; exact.
template <class Real>
TANDEM_HD_INLINE Ray<Real> to_real(const Ray<float>& ray) {
    return {broadcast<Real>(ray.origin), broadcast<Real>(ray.direction)};
}

/// Largest magnitude of a coordinate in a scene or a ray. Embree aborts beyond 1.8e18 and drops primitives there.
inline constexpr float coordinate_limit = 1e18F;

/// True for traceable rays: finite, coordinates within coordinate_limit, direction not zero. All others miss on every
/// backend. (NaN fails every comparison.)
template <class Real>
TANDEM_HD_INLINE Mask<Real> is_traceable(const Ray<Real>& ray) {
    const auto within = [](const Real& a) { return absolute(a) <= Real(coordinate_limit); };
    return within(ray.origin.x) && within(ray.origin.y) && within(ray.origin.z) && within(ray.direction.x) &&
           within(ray.direction.y) && within(ray.direction.z) && norm1(ray.direction) > Real(0);
}

}  // namespace tandem
