/// A perfect mirror.
#pragma once

#include "tandem/kernel/bsdf/lobe.h"
#include "tandem/kernel/bsdf/reflect.h"

namespace tandem {

/// All light that is reflected goes in the mirror direction. Held by tests/kernel/bsdf/specular_lobes_test.cpp.
template <class Real>
struct Mirror {
    using D = Double<Real>;
    static constexpr LobeFlags flags = LobeFlags::reflection | LobeFlags::specular;
    static constexpr int numbers = 0;

    Vec3<Real> reflectance;  ///< RGB, each in [0, 1]

    [[nodiscard]] TANDEM_HD Vec3<Real> f(const Vec3<D>&, const Vec3<D>&) const { return black<Real>(); }
    [[nodiscard]] TANDEM_HD D pdf(const Vec3<D>&, const Vec3<D>&) const { return D(0.0F); }

    [[nodiscard]] TANDEM_HD LobeSample<Real> sample(const Vec3<D>& wo, const Vec3<D>& u) const {
        return sample_about(local_normal<Real>(), wo, u);
    }

    /// The same in any frame: `normal` is a unit vector in that of `wo`. A caller that has the directions in world
    /// space saves the way to the local frame and back, and its rounding.
    [[nodiscard]] TANDEM_HD LobeSample<Real> sample_about(const Vec3<D>& normal, const Vec3<D>& wo,
                                                          const Vec3<D>&) const {
        const Mask<Real> valid = dot(wo, normal) >= D(0.0F);
        return {reflect(-wo, normal), select(valid, constant<D>(infinite_density), D(0.0F)),
                select(valid, reflectance, black<Real>()), valid, Mask<Real>(false)};
    }

    [[nodiscard]] TANDEM_HD Vec3<Real> albedo(const Vec3<D>&) const { return reflectance; }
};

}  // namespace tandem
