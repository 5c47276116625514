/// Schlick's approximation of Fresnel's formulas for microfacets, from the reflectances at normal and at grazing
/// incidence.
///
/// Source: C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", Eurographics 1994, as in glTF 2.0,
///         appendix B. Tested by tests/kernel/bsdf/ggx_reflection_test.cpp.
#pragma once

#include "tandem/kernel/bsdf/lobe.h"

namespace tandem {

/// (1 - cosine)^5, the weight of f90; cosine in [0, 1], or slightly above by rounding.
template <class Real>
TANDEM_HD_INLINE Real schlick_weight(const Double<Real>& cosine) {
    using D = Double<Real>;
    const D rest = greater(D(1.0F) - cosine, D(0.0F));
    const D square = rest * rest;
    return to_real<Real>(square * square * rest);
}

/// The same for the microfacet that mirrors wo to wi. Its normal halves their angle, and |wo + wi| / 2 is the cosine of
/// the half. This needs no quotient, and is accurate at grazing angles too.
template <class Real>
TANDEM_HD_INLINE Real schlick_weight_between(const Vec3<Double<Real>>& wo, const Vec3<Double<Real>>& wi) {
    const Vec3<Double<Real>> both = wo + wi;
    return schlick_weight<Real>(Double<Real>(0.5F) * square_root(dot(both, both)));
}

/// Reflectance for a weight; `f0`: at normal incidence, `f90`: at grazing incidence.
template <class Real>
TANDEM_HD_INLINE Vec3<Real> schlick(const Vec3<Real>& f0, const Real& f90, const Real& weight) {
    return f0 + (Vec3<Real>{f90, f90, f90} - f0) * weight;
}

/// 1 - reflectance.
template <class Real>
TANDEM_HD_INLINE Real schlick_transmittance(const Real& f0, const Real& weight) {
    return (Real(1.0F) - f0) * (Real(1.0F) - weight);
}

}  // namespace tandem
