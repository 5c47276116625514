/// A smooth border between two clear media.
#pragma once

#include "tandem/kernel/bsdf/fresnel.h"
#include "tandem/kernel/bsdf/lobe.h"
#include "tandem/kernel/bsdf/reflect.h"

namespace tandem {

/// Reflects or refracts: each is chosen with its share of the light, Fresnel's reflectance, so that the weight is 1.
/// Radiance is followed as L / n^2, which borders leave as it is. Total internal reflection always reflects.
/// Source: E. Veach's thesis, 1997, 5.2. Held by tests/kernel/bsdf/specular_lobes_test.cpp.
template <class Real>
struct Dielectric {
    using D = Double<Real>;
    static constexpr LobeFlags flags = LobeFlags::reflection | LobeFlags::transmission | LobeFlags::specular;
    static constexpr int numbers = 1;

    D eta;  ///< refractive index on the side of wo over that of the other side, > 0

    [[nodiscard]] TANDEM_HD Vec3<Real> f(const Vec3<D>&, const Vec3<D>&) const { return black<Real>(); }
    [[nodiscard]] TANDEM_HD D pdf(const Vec3<D>&, const Vec3<D>&) const { return D(0.0F); }

    [[nodiscard]] TANDEM_HD LobeSample<Real> sample(const Vec3<D>& wo, const Vec3<D>& u) const {
        return sample_about(local_normal<Real>(), wo, u);
    }

    /// The same in any frame, as Mirror::sample_about().
    [[nodiscard]] TANDEM_HD LobeSample<Real> sample_about(const Vec3<D>& normal, const Vec3<D>& wo,
                                                          const Vec3<D>& u) const {
        const Refraction<Real> refraction = refract<Real>(-wo, normal, eta);
        const Mask<Real> transmits = !(u.x < fresnel_dielectric(refraction, eta));
        const Vec3<D> wi = select(transmits, refraction.direction, reflect(-wo, normal));
        const Mask<Real> valid = dot(wo, normal) >= D(0.0F);
        return {wi, select(valid, constant<D>(infinite_density), D(0.0F)), select(valid, white<Real>(), black<Real>()),
                valid, transmits && valid};
    }

    [[nodiscard]] TANDEM_HD Vec3<Real> albedo(const Vec3<D>&) const { return white<Real>(); }
};

}  // namespace tandem
