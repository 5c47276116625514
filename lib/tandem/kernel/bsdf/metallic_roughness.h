/// From glTF's metallic-roughness parameters to lobes.
#pragma once

#include "tandem/effects/effects.h"
#include "tandem/kernel/bsdf/coated_diffuse.h"
#include "tandem/kernel/bsdf/ggx_reflection.h"
#include "tandem/kernel/bsdf/material_point.h"
#include "tandem/kernel/bsdf/microfacets.h"

namespace tandem {

/// A material of glTF 2.0, at one point of the surface: factors times textures.
template <class Real>
struct MetallicRoughness {
    Vec3<Real> base_colour;        ///< linear RGB, each in [0, 1]
    Real metallic;                 ///< in [0, 1]
    Real roughness;                ///< in [0, 1]
    Real ior = Real(1.5F);         ///< of the dielectric, >= 1: KHR_materials_ior
    Real anisotropy = Real(0.0F);  ///< in [0, 1]: anisotropyStrength of KHR_materials_anisotropy
};

/// The sum of the two is the material's BSDF.
template <class Real>
struct MetallicRoughnessLobes {
    GgxReflection<Real> specular;
    CoatedDiffuse<Real> diffuse;
};

/// The BSDF of glTF 2.0, appendix B: mix(dielectric, metal, metallic).
///
/// Schlick's reflectance is linear in f0, so the specular parts of dielectric and metal are one lobe, whose f0 is the
/// mix of theirs: the sum is that of the appendix, and no approximation. The direction of KHR_materials_anisotropy is
/// the frame's x. Tested by tests/kernel/bsdf/metallic_roughness_test.cpp.
template <class Real>
TANDEM_HD_INLINE MetallicRoughnessLobes<Real> lobes_of(const MetallicRoughness<Real>& material) {
    using D = Double<Real>;
    const Real one(1.0F);
    const Real dielectric = one - material.metallic;
    const Real root = (material.ior - one) / (material.ior + one);
    const Real f0 = root * root;
    const Vec3<Real> mixed = material.base_colour * material.metallic + Vec3<Real>{f0, f0, f0} * dielectric;
    const D roughness = widen(material.roughness);
    const D strength = widen(material.anisotropy);
    const D alpha = roughness * roughness;
    const D along = alpha + (D(1.0F) - alpha) * (strength * strength);
    return {{mixed, one, Ggx<Real>(along, alpha)}, {{material.base_colour * dielectric}, f0}};
}

/// Replaces the diffuse and the specular term of Phong's model, and leaves metals no ambient light.
template <class Effects, class Real, class Reflectance>
TANDEM_HD void apply(const Microfacets& facets, const MaterialPoint<Real>& at, Reflectance& surface) {
    auto& lobes = surface.lobes;
    const Real metallic = Real(facets.metallic) * at.texels.metallic_roughness.b;
    const Real roughness = Real(facets.roughness) * at.texels.metallic_roughness.g;
    Real anisotropy(0.0F);
    if (Effects::has(Effect::anisotropy)) anisotropy = Real(facets.anisotropy) * at.texels.anisotropy;
    const MetallicRoughnessLobes<Real> both =
        lobes_of<Real>({lobes.diffuse.reflectance, metallic, roughness, Real(at.optics.ior), anisotropy});
    surface.ambient = surface.ambient * (Real(1.0F) - metallic);
    lobes.microfacets = both.specular;
    lobes.coated = both.diffuse;
    lobes.diffuse = {};
    lobes.phong.specular = black<Real>();
}

}  // namespace tandem
