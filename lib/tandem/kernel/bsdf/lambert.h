/// A diffuse surface: it scatters light equally in all directions.
#pragma once

#include "tandem/kernel/bsdf/lobe.h"
#include "tandem/kernel/sampler/warp.h"

namespace tandem {

/// f = reflectance / pi, drawn in proportion to the cosine, so that the weight is the reflectance, to the bit.
/// Source: J. H. Lambert, "Photometria", 1760. Held by tests/kernel/bsdf/lambert_test.cpp and all_lobes_test.cpp.
template <class Real>
struct Lambert {
    using D = Double<Real>;
    static constexpr LobeFlags flags = LobeFlags::reflection | LobeFlags::diffuse;
    static constexpr int numbers = 2;

    Vec3<Real> reflectance;  ///< RGB, each in [0, 1]

    [[nodiscard]] TANDEM_HD Vec3<Real> f(const Vec3<D>& wo, const Vec3<D>& wi) const {
        return select(both_above<Real>(wo, wi), reflectance * constant<Real>(inverse_pi), black<Real>());
    }

    [[nodiscard]] TANDEM_HD D pdf(const Vec3<D>& wo, const Vec3<D>& wi) const {
        return select(wo.z > D(0.0F), cosine_hemisphere_pdf(wi.z), D(0.0F));
    }

    [[nodiscard]] TANDEM_HD LobeSample<Real> sample(const Vec3<D>& wo, const Vec3<D>& u) const {
        const DirectionSample<Real> drawn = sample_cosine_hemisphere<Real>(local_normal<Real>(), u.x, u.y);
        const Mask<Real> valid = wo.z > D(0.0F);
        return {drawn.direction, select(valid, drawn.pdf, D(0.0F)), select(valid, reflectance, black<Real>()), valid,
                Mask<Real>(false)};
    }

    [[nodiscard]] TANDEM_HD Vec3<Real> albedo(const Vec3<D>&) const { return reflectance; }
};

}  // namespace tandem
