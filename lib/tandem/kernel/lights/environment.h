/// The background that rays see if they hit nothing, and the ambient light of Phong materials.
#pragma once

#include <cstdint>

#include "tandem/math/vec.h"

namespace tandem {

/// A vertical gradient: (1 - m) bottom + m top, m = (y + 1) / 2 with y of the unit direction. RGB, linear.
struct Environment {
    Vec3f bottom{1.0F, 1.0F, 1.0F};
    Vec3f top{0.5F, 0.7F, 1.0F};
    Vec3f ambient{1.0F, 1.0F, 1.0F};  ///< ia of Phong's model
    std::uint32_t illuminates = 0;    ///< 1: the background lights diffuse surfaces
};

/// `height`: y of the unit direction.
template <class Real>
TANDEM_HD Vec3<Real> gradient(const Environment& environment, const Real& height) {
    const Real m = (height + Real(1.0F)) * Real(0.5F);
    return broadcast<Real>(environment.bottom) * (Real(1.0F) - m) + broadcast<Real>(environment.top) * m;
}

/// Radiance along a direction, whose length is within [1e-15, 1e15]. Within 3 ulp of float.
template <class Real>
TANDEM_HD Vec3<Real> background(const Environment& environment, const Vec3<Real>& direction) {
    return gradient<Real>(environment, direction.y / square_root(dot(direction, direction)));
}

}  // namespace tandem
