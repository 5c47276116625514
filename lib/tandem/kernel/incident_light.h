/// A light as a vertex of a path receives it.
#pragma once

#include "tandem/kernel/lit_vertex.h"

namespace tandem {

template <class Real>
struct IncidentLight {
    Vec3<Real> reflected;              ///< reflected radiance if nothing blocks the light; 0 where it contributes none
    Vec3<Real> position_or_direction;  ///< of the light; a direction if `is_far`
    UInt<Real> primitive = UInt<Real>(no_primitive);  ///< of the light
    Mask<Real> is_far = Mask<Real>(false);            ///< at infinite distance
    Mask<Real> casts_shadows = Mask<Real>(true);

    /// `a` in the lanes of `mask`, else `b`.
    TANDEM_HD friend IncidentLight select(const Mask<Real>& mask, const IncidentLight& a, const IncidentLight& b) {
        return {select(mask, a.reflected, b.reflected), select(mask, a.position_or_direction, b.position_or_direction),
                select(mask, a.primitive, b.primitive), select(mask, a.is_far, b.is_far),
                select(mask, a.casts_shadows, b.casts_shadows)};
    }
};

/// Whether a direction is in front of the surface: of the shading normal, and on the viewer's side. Lights that cast
/// shadows must be there. Otherwise a highlight would pass through an opaque face, since Phong's formula does not
/// require L . N > 0 and the shadow ray starts on the light's side. A light exactly in the plane of a face counts as
/// behind it.
template <class Real>
TANDEM_HD Mask<Real> is_in_front(const LitVertex<Real>& at, const Vec3<Double<Real>>& to_light) {
    const Double<Real> zero(0.0);
    const Double<Real> height = dot(to_light, at.point.normal);
    const Mask<Real> on_side = select(at.point.from_inside, -height, height) > zero;
    return on_side && dot(to_light, at.surface.normal) > zero;
}

}  // namespace tandem
