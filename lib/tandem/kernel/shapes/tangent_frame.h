/// The tangent frame that normal maps are relative to.
#pragma once

#include "tandem/math/frame.h"

namespace tandem {

/// An orthonormal frame around the unit `normal`: the tangent in the direction of growing u, the bitangent in that of
/// falling v, which is up in the image. Left-handed where the image is mirrored.
///
/// `dp_du`, `dp_dv`: the directions of growing u and v on the surface, of any length, not necessarily orthogonal to the
/// normal or to each other. Where dp_du is zero or parallel to the normal, the frame is frame_around(). The tangent is
/// dp_du without its component along the normal, after E. Lengyel, "Mathematics for 3D Game Programming and Computer
/// Graphics", 7.8. Tested by tests/kernel/shapes/parametrisation_test.cpp.
template <class D>
TANDEM_HD_INLINE Frame<D> tangent_frame(const Vec3<D>& normal, const Vec3<D>& dp_du, const Vec3<D>& dp_dv) {
    const Vec3<D> flat = dp_du - normal * dot(normal, dp_du);
    const D length2 = dot(flat, flat);
    const auto enough = length2 > constant<D>(0x1p-30) * dot(dp_du, dp_du);
    const Vec3<D> along = normalize(flat);
    const Vec3<D> any = frame_around(normal).tangent;
    const Vec3<D> tangent = {select(enough, along.x, any.x), select(enough, along.y, any.y),
                             select(enough, along.z, any.z)};
    const Vec3<D> up = cross(normal, tangent);
    const auto mirrored = dot(up, dp_dv) > D(0.0F);
    return {
        tangent, {select(mirrored, -up.x, up.x), select(mirrored, -up.y, up.y), select(mirrored, -up.z, up.z)}, normal};
}

}  // namespace tandem
