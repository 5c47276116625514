/// A smooth interface between two clear media.
#pragma once

#include "tandem/kernel/bsdf/fresnel.h"
#include "tandem/kernel/bsdf/specular_directions.h"

namespace tandem {

/// Reflects with a probability of Fresnel's reflectance, else refracts, so that the weight is `share`. Paths carry L /
/// n^2, which interfaces leave unchanged. Total internal reflection always reflects.
/// Source: E. Veach's thesis, 1997, 5.2. Tested by tests/kernel/bsdf/specular_lobes_test.cpp.
template <class Real>
struct Dielectric {
    using D = Double<Real>;
    static constexpr LobeFlags flags = LobeFlags::reflection | LobeFlags::transmission | LobeFlags::specular;
    static constexpr int numbers = 1;

    Real share;  ///< of the light, in [0, 1]; the rest goes to the other lobes of the surface
    D eta;       ///< refractive index on the side of wo over that of the other side, > 0

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> colour() const { return {share, share, share}; }
    [[nodiscard]] TANDEM_HD_INLINE Mask<Real> scatters() const { return share > Real(0.0F); }

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> f(const Vec3<D>&, const Vec3<D>&) const { return black<Real>(); }
    [[nodiscard]] TANDEM_HD_INLINE D pdf(const Vec3<D>&, const Vec3<D>&) const { return D(0.0F); }

    [[nodiscard]] TANDEM_HD_INLINE LobeSample<Real> sample(const Vec3<D>& wo, const Vec3<D>& u) const {
        return sample_about({local_normal<Real>(), local_normal<Real>()}, wo, u).only_where(wo.z >= D(0.0F));
    }

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> albedo(const Vec3<D>&) const { return {share, share, share}; }

    [[nodiscard]] TANDEM_HD_INLINE LobeSample<Real> sample_about(const LobeNormals<Real>& normals, const Vec3<D>& wo,
                                                                 const Vec3<D>& u) const {
        const Refraction<Real> refraction = refracted<Real>(normals, wo, eta);
        const Mask<Real> transmits = !(u.x < fresnel_dielectric(refraction, eta));
        Vec3<D> wi = refraction.direction;
        if (any(!transmits)) wi = select(transmits, wi, mirrored<Real>(normals, wo));
        return {wi, constant<D>(infinite_density), {share, share, share}, Mask<Real>(true), transmits};
    }

    TANDEM_HD_INLINE friend Dielectric select(const Mask<Real>& mask, const Dielectric& a, const Dielectric& b) {
        return {select(mask, a.share, b.share), select(mask, a.eta, b.eta)};
    }
};

}  // namespace tandem
