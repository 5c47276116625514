/// A sampled point of a light, seen from the lit point.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

template <class Real>
struct LightSample {
    Vec3<Double<Real>> direction;  ///< unit, from the lit point to the light; valid where pdf > 0
    Vec3<Double<Real>> point;      ///< on the light, world space
    Double<Real> distance;         ///< from the lit point, metres
    Double<Real> pdf;              ///< of the direction with respect to solid angle, 1/sr; 0: the light is not visible
    Mask<Real> in_second_half = Mask<Real>(false);  ///< of a quad: `point` is on the triangle (v0, v2, v3)
};

/// The relative distance beyond the edge of a light up to which a direction still hits it: samples are rounded, and the
/// density of a sample must not be 0.
template <class Real>
inline constexpr double direction_slack = is_fast<Real> ? 0x1p-20 : 0x1p-49;

}  // namespace tandem
