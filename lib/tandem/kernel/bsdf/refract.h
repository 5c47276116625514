/// The refracted direction, and whether there is one.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// The ray beyond an interface. Valid where `transmits`; elsewhere all light is reflected.
template <class Real>
struct Refraction {
    Mask<Real> transmits;
    Vec3<Double<Real>> direction;  ///< unit
    Double<Real> cosine_in;        ///< of the angle of incidence, in [0, 1]
    Double<Real> cosine_out;       ///< of the angle of refraction, in [0, 1]
};

/// Snell's law.
///
/// Needs: `direction` and `normal` unit vectors in double, the normal on the side that the ray comes from (their dot
///        product is not positive); `eta`, the refractive index of that side over that of the other, > 0.
/// Gives: total internal reflection where eta sin > 1, decided correctly unless eta sin is within 2^-40 of 1; exactly
///        at 1 the ray leaves along the interface. cosine_out within 1e-7 near that limit. Equal indices, eta = 1,
///        leave the bits of the direction unchanged. A NaN does not transmit.
/// Method: the sine is the length of direction x normal, which does not cancel. 1 - eta^2 (1 - cos^2) does, near that
///         limit and near normal incidence, where the cosine hardly determines the angle.
/// Tested by tests/kernel/bsdf/refract_test.cpp and group F of the corpus (tests/hard).
template <class Real>
TANDEM_HD_INLINE Refraction<Real> refract(const Vec3<Double<Real>>& direction, const Vec3<Double<Real>>& normal,
                                          const Double<Real>& eta) {
    using D = Double<Real>;
    const D zero(0.0);
    const D one(1.0);
    const Vec3<D> sine_in = accurate_cross(direction, normal);
    const D sine2_out = (eta * eta) * dot(sine_in, sine_in);
    const Mask<Real> straight = eta == one;
    Refraction<Real> result;
    result.transmits = straight || sine2_out <= one;
    result.cosine_in = lesser(greater(-dot(direction, normal), zero), one);
    const D cosine_out = square_root(greater(one - sine2_out, zero));
    result.cosine_out = select(straight, result.cosine_in, cosine_out);
    // eta (d + cos_in n) - cos_out n
    const D along = eta * result.cosine_in - cosine_out;
    const Vec3<D> bent = normalize(Vec3<D>{eta * direction.x + along * normal.x, eta * direction.y + along * normal.y,
                                           eta * direction.z + along * normal.z});
    result.direction = {select(straight, direction.x, bent.x), select(straight, direction.y, bent.y),
                        select(straight, direction.z, bent.z)};
    return result;
}

}  // namespace tandem
