/// The reflectance of an interface between two dielectrics.
#pragma once

#include "tandem/kernel/bsdf/refract.h"

namespace tandem {

/// Reflectance R of unpolarised light; the transmittance is 1 - R, so that energy is conserved.
///
/// Gives: R in [0, 1]; 1 for total internal reflection and for grazing incidence, 0 for equal indices at every angle.
///        Within 1e-12 of Fresnel's formulas for the cosines given.
/// Source: A. Fresnel, 1823, as in M. Born, E. Wolf, "Principles of Optics", 1.5.2.
/// Tested by tests/kernel/bsdf/fresnel_test.cpp and group F of the corpus (tests/hard).
template <class Real>
TANDEM_HD_INLINE Double<Real> fresnel_dielectric(const Refraction<Real>& refraction, const Double<Real>& eta) {
    using D = Double<Real>;
    const D zero(0.0);
    const D one(1.0);
    const D& in = refraction.cosine_in;
    const D& out = refraction.cosine_out;
    const D perpendicular = (eta * in - out) / (eta * in + out);
    const D parallel = (in - eta * out) / (in + eta * out);
    const D reflectance = D(0.5) * (perpendicular * perpendicular + parallel * parallel);
    // both cosines are 0 only for equal indices, where the quotients are not used
    return select(eta == one, zero, select(refraction.transmits, lesser(reflectance, one), one));
}

}  // namespace tandem
