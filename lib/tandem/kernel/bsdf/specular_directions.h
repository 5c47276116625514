/// Directions of specular lobes where the shading normal may differ from the geometric one.
#pragma once

#include "tandem/kernel/bsdf/lobe.h"
#include "tandem/kernel/bsdf/reflect.h"
#include "tandem/kernel/bsdf/refract.h"

namespace tandem {

/// `wo` mirrored at the shading normal; at the geometric normal where the direction would otherwise go through the
/// surface.
template <class Real>
TANDEM_HD_INLINE Vec3<Double<Real>> mirrored(const LobeNormals<Real>& normals, const Vec3<Double<Real>>& wo) {
    const Vec3<Double<Real>> direction = reflect(-wo, normals.shading);
    const Mask<Real> through = !(dot(direction, normals.geometric) > Double<Real>(0.0));
    if (!any(through)) return direction;
    return select(through, reflect(-wo, normals.geometric), direction);
}

/// refract() at the shading normal; at the geometric normal where the direction would otherwise not go through the
/// surface. `eta`: the refractive index on the side of wo over that of the other side.
template <class Real>
TANDEM_HD_INLINE Refraction<Real> refracted(const LobeNormals<Real>& normals, const Vec3<Double<Real>>& wo,
                                            const Double<Real>& eta) {
    Refraction<Real> result = refract<Real>(-wo, normals.shading, eta);
    const Mask<Real> back = result.transmits && !(dot(result.direction, normals.geometric) < Double<Real>(0.0));
    if (!any(back)) return result;
    const Refraction<Real> other = refract<Real>(-wo, normals.geometric, eta);
    result.transmits = select(back, other.transmits, result.transmits);
    result.direction = select(back, other.direction, result.direction);
    result.cosine_in = select(back, other.cosine_in, result.cosine_in);
    result.cosine_out = select(back, other.cosine_out, result.cosine_out);
    return result;
}

}  // namespace tandem
