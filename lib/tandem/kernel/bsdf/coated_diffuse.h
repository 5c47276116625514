/// The diffuse base of a dielectric, below an interface that reflects part of the light.
#pragma once

#include "tandem/kernel/bsdf/lambert.h"
#include "tandem/kernel/bsdf/schlick.h"

namespace tandem {

/// f = reflectance / pi (1 - F), with F of the microfacet that would mirror wo to wi: the diffuse term of a dielectric
/// in glTF 2.0, appendix B, below the reflection (GgxReflection with the same f0). Sampled as Lambert.
///
/// By itself it conserves energy. With a smooth interface the two together gain energy at grazing angles, because F of
/// the facet in between is small there for most light: a white base under an interface with f0 = 0.04 reflects 1.15 at
/// 73 degrees and 1.72 at 87 degrees. With alpha >= 1/2 it is less than 1.05. This is a property of the model in the
/// appendix.
///
/// Tested by tests/kernel/bsdf/coated_diffuse_test.cpp and all_lobes_test.cpp.
template <class Real>
struct CoatedDiffuse {
    using D = Double<Real>;
    static constexpr LobeFlags flags = LobeFlags::reflection | LobeFlags::diffuse;
    static constexpr int numbers = 2;

    Lambert<Real> base;
    Real f0;  ///< reflectance of the interface at normal incidence, in [0, 1]

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> colour() const { return base.colour(); }
    [[nodiscard]] TANDEM_HD_INLINE Mask<Real> scatters() const { return base.scatters(); }

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> f(const Vec3<D>& wo, const Vec3<D>& wi) const {
        return base.f(wo, wi) * enters(wo, wi);
    }

    [[nodiscard]] TANDEM_HD_INLINE D pdf(const Vec3<D>& wo, const Vec3<D>& wi) const { return base.pdf(wo, wi); }

    [[nodiscard]] TANDEM_HD_INLINE LobeSample<Real> sample(const Vec3<D>& wo, const Vec3<D>& u) const {
        LobeSample<Real> drawn = base.sample(wo, u);
        drawn.weight = drawn.weight * enters(wo, drawn.wi);
        return drawn;
    }

    /// Approximated without the increase of F at grazing angles.
    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> albedo(const Vec3<D>& wo) const {
        return base.albedo(wo) * (Real(1.0F) - f0);
    }

    TANDEM_HD_INLINE friend CoatedDiffuse select(const Mask<Real>& mask, const CoatedDiffuse& a,
                                                 const CoatedDiffuse& b) {
        return {select(mask, a.base, b.base), select(mask, a.f0, b.f0)};
    }

  private:
    [[nodiscard]] TANDEM_HD_INLINE Real enters(const Vec3<D>& wo, const Vec3<D>& wi) const {
        return schlick_transmittance(f0, schlick_weight_between<Real>(wo, wi));
    }
};

}  // namespace tandem
