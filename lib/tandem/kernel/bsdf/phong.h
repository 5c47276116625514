/// The material of Phong's reflection model, and the power of its highlight. Its terms are the lobes lambert.h and
/// phong_lobe.h.
#pragma once

#include "tandem/math/exact_math.h"
#include "tandem/math/fast_math.h"
#include "tandem/math/vec.h"

namespace tandem {

/// Reflectances per RGB channel, linear, each in [0, 1]; shininess >= 0.
struct PhongMaterial {
    Vec3f ambient{0.08F, 0.08F, 0.08F};  ///< ka
    Vec3f diffuse{0.8F, 0.8F, 0.8F};     ///< kd
    Vec3f specular{1.0F, 1.0F, 1.0F};    ///< ks
    float shininess = 32.0F;             ///< alpha
};

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

}  // namespace tandem
