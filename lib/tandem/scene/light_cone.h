/// The cone of a spot light, as kernels read it (kernel/lights/punctual_light.h).
#pragma once

#include "tandem/math/accurate_functions.h"

namespace tandem {

struct LightCone {
    double height;  ///< 1 - cosine of the outer angle
    double scale;   ///< 1 / (cosine of the inner angle - cosine of the outer one); infinite if they are equal
};

/// Angles from the axis, in radians. Accurate for cones of any width: nothing cancels.
[[nodiscard]] inline LightCone light_cone(double inner, double outer) {
    const double half = accurate_sin(outer / 2);
    return {2 * half * half, 1 / (2 * accurate_sin((outer + inner) / 2) * accurate_sin((outer - inner) / 2))};
}

}  // namespace tandem
