/// The direction in which microfacets are rougher: KHR_materials_anisotropy.
#pragma once

#include "tandem/kernel/texture/texture_set.h"
#include "tandem/math/frame.h"

namespace tandem {

/// Of one material. Its strength is Microfacets::anisotropy.
struct Anisotropy {
    float x = 1, y = 0;      ///< the direction along tangent and bitangent; with a texture, it turns the texture's
    std::uint32_t slot = 0;  ///< of the texture coordinates that the tangent comes from
    TextureUse texture{};    ///< red and green: the direction; blue multiplies the strength
};
static_assert(sizeof(Anisotropy) == 44, "no byte is undefined; scene_hash() reads all");

/// The value without a texture: along the tangent, of full strength.
template <class Real>
TANDEM_HD_INLINE Rgba<Real> default_anisotropy_texel() {
    return {Real(1.0F), Real(0.5F), Real(1.0F), Real(1.0F)};
}

/// The unit tangent along which the microfacets are rougher, world space.
///
/// `frame`: of the surface, tangent along growing u, bitangent along falling v (tangent_frame()). `texel`: red and
/// green from 0 to 1 are coordinates from -1 to 1 along tangent and bitangent, turned by the material's direction.
/// Where they vanish it is as without a texture. The result's sign does not matter: grooves have none. Source:
/// KHR_materials_anisotropy.
template <class Real>
TANDEM_HD_INLINE Vec3<Double<Real>> rough_tangent(const Anisotropy& anisotropy, const Frame<Double<Real>>& frame,
                                                  const Rgba<Real>& texel) {
    using D = Double<Real>;
    const D r = signed_level<Real>(texel.r);
    const D g = signed_level<Real>(texel.g);
    const Mask<Real> enough = r * r + g * g > D(0x1p-40F);
    const D x = select(enough, r, D(1.0F));
    const D y = select(enough, g, D(0.0F));
    const D cosine = D(anisotropy.x);
    const D sine = D(anisotropy.y);
    return normalize(frame.tangent * (cosine * x - sine * y) + frame.bitangent * (sine * x + cosine * y));
}

}  // namespace tandem
