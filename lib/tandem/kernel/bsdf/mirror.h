/// A perfect mirror.
#pragma once

#include "tandem/kernel/bsdf/specular_directions.h"

namespace tandem {

/// Reflects into the mirror direction only. Tested by tests/kernel/bsdf/specular_lobes_test.cpp.
template <class Real>
struct Mirror {
    using D = Double<Real>;
    static constexpr LobeFlags flags = LobeFlags::reflection | LobeFlags::specular;
    static constexpr int numbers = 0;

    Vec3<Real> reflectance;  ///< RGB, each in [0, 1]

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> colour() const { return reflectance; }
    [[nodiscard]] TANDEM_HD_INLINE Mask<Real> scatters() const { return norm1(reflectance) > Real(0.0F); }

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> f(const Vec3<D>&, const Vec3<D>&) const { return black<Real>(); }
    [[nodiscard]] TANDEM_HD_INLINE D pdf(const Vec3<D>&, const Vec3<D>&) const { return D(0.0F); }

    [[nodiscard]] TANDEM_HD_INLINE LobeSample<Real> sample(const Vec3<D>& wo, const Vec3<D>& u) const {
        return sample_about({local_normal<Real>(), local_normal<Real>()}, wo, u).only_where(wo.z >= D(0.0F));
    }

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> albedo(const Vec3<D>&) const { return reflectance; }

    [[nodiscard]] TANDEM_HD_INLINE LobeSample<Real> sample_about(const LobeNormals<Real>& normals, const Vec3<D>& wo,
                                                                 const Vec3<D>&) const {
        return {mirrored<Real>(normals, wo), constant<D>(infinite_density), reflectance, Mask<Real>(true),
                Mask<Real>(false)};
    }

    TANDEM_HD_INLINE friend Mirror select(const Mask<Real>& mask, const Mirror& a, const Mirror& b) {
        return {select(mask, a.reflectance, b.reflectance)};
    }
};

}  // namespace tandem
