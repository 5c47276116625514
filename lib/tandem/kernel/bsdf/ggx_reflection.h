/// Reflection from a rough surface: a metal, or the interface of a dielectric above another lobe.
#pragma once

#include "tandem/kernel/bsdf/ggx.h"
#include "tandem/kernel/bsdf/reflect.h"
#include "tandem/kernel/bsdf/schlick.h"

namespace tandem {

/// f = F D G2 / (4 cos_o cos_i): microfacets that are mirrors, after Torrance and Sparrow, with GGX, height-correlated
/// masking and Schlick's Fresnel term, as in glTF 2.0, appendix B.
///
/// Light that hits a second microfacet is lost, as in most renderers: there is no term for multiple scattering. At
/// normal incidence a white surface (f0 = 1) reflects 1 - ln 2 = 31 % with alpha = 1, 69 % with 1/2, 95 % with 1/5.
///
/// Method: reflects wo at a sampled visible normal: pdf = G1 D / (4 cos_o), whose integral over the whole sphere is 1,
///         and the weight is F G2 / G1 <= 1. Directions below the horizon are not valid; they are part of the loss.
/// Gives: a relative error of pdf below 2^-36 for every alpha; of f too in precise; of f below 2^-21 in strict. With f0
///        = 0 the error of Schlick's (1 - cos)^5 comes on top. A small alpha magnifies the rounding of wo + wi.
/// Source: as ggx.h and schlick.h. Tested by tests/kernel/bsdf/ggx_reflection_test.cpp and all_lobes_test.cpp.
template <class Real>
struct GgxReflection {
    using D = Double<Real>;
    static constexpr LobeFlags flags = LobeFlags::reflection | LobeFlags::glossy;
    static constexpr int numbers = 2;

    Vec3<Real> f0;  ///< reflectance at normal incidence, RGB, each in [0, 1]
    Real f90;       ///< at grazing incidence: 1, or 0 for no lobe
    Ggx<Real> facets;

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> colour() const { return f0; }
    [[nodiscard]] TANDEM_HD_INLINE Mask<Real> scatters() const { return f90 > Real(0.0F); }

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> f(const Vec3<D>& wo, const Vec3<D>& wi) const {
        const D divisor = bounded_divisor<Real>(facets.mutual_extent(wo, wi));
        const Real value = to_real<Real>(D(0.5F) * facets.density(wo + wi) / divisor);
        return select(both_above<Real>(wo, wi), fresnel(wo, wi) * value, black<Real>());
    }

    [[nodiscard]] TANDEM_HD_INLINE D pdf(const Vec3<D>& wo, const Vec3<D>& wi) const {
        const D value = D(0.5F) * facets.density(wo + wi) / (wo.z + facets.extent(wo));
        return select(both_above<Real>(wo, wi), value, D(0.0F));
    }

    [[nodiscard]] TANDEM_HD_INLINE LobeSample<Real> sample(const Vec3<D>& wo, const Vec3<D>& u) const {
        const Vec3<D> wi = reflect(-wo, facets.sample_seen(wo, u.x, u.y));
        const D density = pdf(wo, wi);
        const Mask<Real> valid = both_above<Real>(wo, wi) && density > D(0.0F);
        const D unmasked = wi.z * (wo.z + facets.extent(wo)) / facets.mutual_extent(wo, wi);
        return {wi, density, select(valid, fresnel(wo, wi) * to_real<Real>(unmasked), black<Real>()), valid,
                Mask<Real>(false)};
    }

    /// A fit for equal alphas: within 0.13 of the albedo, and 0.7 to 1.4 times the albedo for f0 >= 0.04.
    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> albedo(const Vec3<D>& wo) const {
        const Real one(1.0F);
        const Real alpha2 = to_real<Real>(facets.alpha_x * facets.alpha_y);
        const Real lost =
            to_real<Real>(square_root(greater(wo.z, D(0.0F)))) * alpha2 * Real(1.3F) / (one + alpha2 * Real(0.9F));
        const Real grazing =
            schlick_weight<Real>(wo.z) / (one + square_root(alpha2) * Real(8.0F) + alpha2 * Real(15.0F));
        return f0 * (one - lost) + (Vec3<Real>{f90, f90, f90} - f0) * grazing;
    }

    TANDEM_HD_INLINE friend GgxReflection select(const Mask<Real>& mask, const GgxReflection& a,
                                                 const GgxReflection& b) {
        GgxReflection result = {select(mask, a.f0, b.f0), select(mask, a.f90, b.f90), a.facets};
        result.facets.alpha_x = select(mask, a.facets.alpha_x, b.facets.alpha_x);
        result.facets.alpha_y = select(mask, a.facets.alpha_y, b.facets.alpha_y);
        return result;
    }

  private:
    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> fresnel(const Vec3<D>& wo, const Vec3<D>& wi) const {
        return schlick(f0, f90, schlick_weight_between<Real>(wo, wi));
    }
};

}  // namespace tandem
