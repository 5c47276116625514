/// One light as a vertex of a path receives it.
#pragma once

#include "tandem/kernel/lit_vertex.h"

namespace tandem {

template <class Real>
struct IncidentLight {
    Vec3<Real> reflected;  ///< radiance reflected of it if nothing blocks it; 0 where it contributes none
    Vec3<Real> to;         ///< its position or, if it is far, its direction
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

/// Is a direction in front of the surface: before the shading normal, and on the viewer's side? Lights that cast
/// shadows must be. Without this a highlight passes through an opaque face, since Phong's formula does not require L .
/// N > 0 and the shadow ray starts on the light's side. A light exactly in the plane of a face counts as behind it.
template <class Real>
TANDEM_HD Mask<Real> is_in_front(const LitVertex<Real>& at, const Vec3<Double<Real>>& to_light) {
    const Double<Real> zero(0.0);
    const Double<Real> height = dot(to_light, at.point.normal);
    const Mask<Real> on_side = select(at.point.from_inside, -height, height) > zero;
    return on_side && dot(to_light, at.surface.normal) > zero;
}

}  // namespace tandem
