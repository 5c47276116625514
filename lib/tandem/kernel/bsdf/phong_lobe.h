/// The highlight of Phong's model as a lobe that can be sampled.
#pragma once

#include "tandem/kernel/bsdf/lobe.h"
#include "tandem/kernel/bsdf/phong.h"
#include "tandem/math/exact_math.h"
#include "tandem/math/fast_math.h"
#include "tandem/math/frame.h"
#include "tandem/math/turns.h"

namespace tandem {

/// cos^shininess with cos clamped to [0, 1]; 0^0 is 1.
///
/// Gives: within 1 ulp of float for every shininess up to 1e8. The cosine stays double, because rounding it to float
///        has a relative error of shininess * 2^-24, 45 % at 1e6 (docs/numerics.md).
template <class Real>
TANDEM_HD_CALL_ON(device)
Real specular_lobe(Double<Real> cosine, Real shininess) {
    using D = Double<Real>;
    const D one(1.0);
    const D clamped = select(cosine > one, one, cosine);
    return to_real<Real>(power<Real>(clamped, widen(shininess)));
}

/// f |cos| = specular (R.V)^shininess / pi, with R the mirror direction. This is reflected_about(), the highlight of
/// the paper, in the units of a BSDF: there, as for area lights, Lambert's 1 / pi is part of the intensity. So a light
/// contributes the same whether the light or the lobe samples its direction.
///
/// Phong's f has the cosine of the light in its divisor, so it is not reciprocal; f |cos| is. The albedo at normal
/// incidence is 2 specular / (shininess + 1), and less elsewhere; with a shininess below 1 it may exceed 1.
///
/// Method: samples directions around the mirror direction with density (n + 1) / (2 pi) cos^n. Those below the horizon
///         are not valid, and their light is lost, since no light comes through the surface. So pdf has the integral 1
///         only where the whole lobe is above the horizon. The weight is 2 specular / (n + 1).
/// Gives: a relative error of pdf and f below n 2^-49 + 2^-47 in precise, and 2^-22 more in strict.
/// Source: B. T. Phong, "Illumination for Computer Generated Pictures", CACM 18(6), 1975; the sampling after
///         E. Lafortune, Y. Willems, "Using the Modified Phong Reflectance Model for Physically Based Rendering", 1994.
/// Tested by tests/kernel/bsdf/phong_lobe_test.cpp and all_lobes_test.cpp.
template <class Real>
struct PhongLobe {
    using D = Double<Real>;
    static constexpr LobeFlags flags = LobeFlags::reflection | LobeFlags::glossy;
    static constexpr int numbers = 2;

    Vec3<Real> specular;  ///< RGB, each in [0, 1]
    Real shininess;       ///< >= 0

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> colour() const { return specular; }
    [[nodiscard]] TANDEM_HD_INLINE Mask<Real> scatters() const { return norm1(specular) > Real(0.0F); }

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> f(const Vec3<D>& wo, const Vec3<D>& wi) const {
        const D divisor = bounded_divisor<Real>(wi.z) * constant<D>(pi);
        const Real value = to_real<Real>(widen(lobe(wo, wi)) / divisor);
        return select(both_above<Real>(wo, wi), specular * value, black<Real>());
    }

    [[nodiscard]] TANDEM_HD_INLINE D pdf(const Vec3<D>& wo, const Vec3<D>& wi) const {
        return select(both_above<Real>(wo, wi), widen(lobe(wo, wi)) * density_at_peak(), D(0.0F));
    }

    [[nodiscard]] TANDEM_HD_INLINE LobeSample<Real> sample(const Vec3<D>& wo, const Vec3<D>& u) const {
        const D one(1.0F);
        // 1 - u is never 0, so neither are the cosine and the density
        const D rest = one - u.x;
        const D cosine = power<Real>(rest, one / (widen(shininess) + one));
        const D sine = square_root((one - cosine) * (one + cosine));
        const SineCosine<Real> turn = sin_cos_turns<Real>(u.y);
        const Vec3<D> wi = from_frame(frame_around(mirrored(wo)), sine * turn.cosine, sine * turn.sine, cosine);
        const Mask<Real> valid = both_above<Real>(wo, wi);
        // cos^n = (1 - u) / cos
        const D density = rest / cosine * density_at_peak();
        return {wi, select(valid, density, D(0.0F)), select(valid, albedo(wo), black<Real>()), valid,
                Mask<Real>(false)};
    }

    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> albedo(const Vec3<D>&) const {
        return specular * (Real(2.0F) / (shininess + Real(1.0F)));
    }

    /// Phong's highlight as in the paper: ks (R.V)^shininess, with R = 2 (L.N) N - L, wherever R.V > 0.
    [[nodiscard]] TANDEM_HD_INLINE Vec3<Real> reflected_about(const Real& share, const Vec3<D>& normal,
                                                              const Vec3<D>& wi, const Vec3<D>& wo) const {
        const D cosine = dot(wi, normal);
        const D twice = cosine + cosine;
        const Vec3<D> along = {twice * normal.x - wi.x, twice * normal.y - wi.y, twice * normal.z - wi.z};
        const D highlight = dot(along, wo);
        const Mask<Real> counts = highlight > D(0.0);
        Real weight(0.0F);
        if (any(counts && scatters())) {
            weight = select(counts, specular_lobe<Real>(select(counts, highlight, D(1.0)), shininess), weight);
        }
        return specular * share * weight;
    }

    TANDEM_HD_INLINE friend PhongLobe select(const Mask<Real>& mask, const PhongLobe& a, const PhongLobe& b) {
        return {select(mask, a.specular, b.specular), select(mask, a.shininess, b.shininess)};
    }

  private:
    [[nodiscard]] TANDEM_HD_INLINE static Vec3<D> mirrored(const Vec3<D>& wo) { return {-wo.x, -wo.y, wo.z}; }

    [[nodiscard]] TANDEM_HD_INLINE Real lobe(const Vec3<D>& wo, const Vec3<D>& wi) const {
        const D cosine = dot(mirrored(wo), wi);
        const Mask<Real> counts = cosine > D(0.0F);
        return select(counts, specular_lobe<Real>(select(counts, cosine, D(1.0F)), shininess), Real(0.0F));
    }

    [[nodiscard]] TANDEM_HD_INLINE D density_at_peak() const {
        return (widen(shininess) + D(1.0F)) * constant<D>(inverse_pi / 2);
    }
};

}  // namespace tandem
