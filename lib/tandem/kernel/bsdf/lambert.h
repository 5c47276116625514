/// A diffuse surface: it scatters light equally in all directions.
#pragma once

#include "tandem/kernel/bsdf/lobe.h"
#include "tandem/kernel/sampler/warp.h"

namespace tandem {

/// f = reflectance / pi, sampled in proportion to the cosine, so that the weight is exactly the reflectance.
/// Source: J. H. Lambert, "Photometria", 1760. Tested by tests/kernel/bsdf/lambert_test.cpp and all_lobes_test.cpp.
template <class Real>
struct Lambert {
    using D = Double<Real>;
    static constexpr LobeFlags flags = LobeFlags::reflection | LobeFlags::diffuse;
    static constexpr int numbers = 2;

    Vec3<Real> reflectance;  ///< RGB, each in [0, 1]

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> colour() const { return reflectance; }
    [[nodiscard]] TANDEM_HD_INLINE Mask<Real> scatters() const { return norm1(reflectance) > Real(0.0F); }

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> f(const Vec3<D>& wo, const Vec3<D>& wi) const {
        return select(both_above<Real>(wo, wi), reflectance * constant<Real>(inverse_pi), black<Real>());
    }

    [[nodiscard]] TANDEM_HD_INLINE D pdf(const Vec3<D>& wo, const Vec3<D>& wi) const {
        return select(wo.z > D(0.0F), cosine_hemisphere_pdf(wi.z), D(0.0F));
    }

    [[nodiscard]] TANDEM_HD_INLINE LobeSample<Real> sample(const Vec3<D>& wo, const Vec3<D>& u) const {
        return sample_about({local_normal<Real>(), local_normal<Real>()}, wo, u).only_where(wo.z > D(0.0F));
    }

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> albedo(const Vec3<D>&) const { return reflectance; }

    [[nodiscard]] TANDEM_HD_INLINE LobeSample<Real> sample_about(const LobeNormals<Real>& normals, const Vec3<D>&,
                                                                 const Vec3<D>& u) const {
        const DirectionSample<Real> drawn = sample_cosine_hemisphere<Real>(normals.shading, u.x, u.y);
        return {drawn.direction, drawn.pdf, reflectance, Mask<Real>(true), Mask<Real>(false)};
    }

    [[nodiscard]] TANDEM_HD_INLINE D pdf_about(const Vec3<D>& normal, const Vec3<D>& wi) const {
        return cosine_hemisphere_pdf(dot(wi, normal));
    }

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> reflected_about(const Real& share, const Vec3<D>& normal,
                                                              const Vec3<D>& wi, const Vec3<D>&) const {
        const D cosine = dot(wi, normal);
        return reflectance * share * to_real<Real>(select(cosine > D(0.0), cosine, D(0.0)));
    }

    TANDEM_HD_INLINE friend Lambert select(const Mask<Real>& mask, const Lambert& a, const Lambert& b) {
        return {select(mask, a.reflectance, b.reflectance)};
    }
};

}  // namespace tandem
