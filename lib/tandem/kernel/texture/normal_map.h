/// Normal mapping.
#pragma once

#include "tandem/kernel/texture/texture_view.h"
#include "tandem/math/frame.h"

namespace tandem {

/// The unit normal of a texel of a normal map, in world space.
///
/// `frame`: of the surface, tangent along growing u, bitangent along falling v (tangent_frame()). Red, green and blue
/// from 0 to 1 are coordinates from -1 to 1 along tangent, bitangent and normal; `scale` multiplies the first two. If
/// all vanish, the result is the frame's normal. For the back of a double-sided face, use the frame of the front and
/// negate the result. Source: glTF 2.0, 3.9.3, normal textures.
template <class Real>
TANDEM_HD_INLINE Vec3<Double<Real>> mapped_normal(const Frame<Double<Real>>& frame, const Rgba<Real>& texel,
                                                  float scale) {
    using D = Double<Real>;
    const Vec3<D> sum = frame.tangent * (signed_level<Real>(texel.r) * D(scale)) +
                        frame.bitangent * (signed_level<Real>(texel.g) * D(scale)) +
                        frame.normal * signed_level<Real>(texel.b);
    const Mask<Real> enough = dot(sum, sum) > D(0x1p-40F);
    const Vec3<D> unit = normalize(sum);
    return {select(enough, unit.x, frame.normal.x), select(enough, unit.y, frame.normal.y),
            select(enough, unit.z, frame.normal.z)};
}

}  // namespace tandem
