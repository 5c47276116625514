/// Where a shadow ray ends.
#pragma once

#include "tandem/kernel/shapes/hit.h"

namespace tandem {

/// The end of a shadow ray: only hits at t < `t` count, compared in double, and none on `light`, the primitive at the
/// end of the ray.
struct RayEnd {
    double t = 0;
    std::uint32_t light = no_primitive;
    std::uint32_t unused = 0;
};

}  // namespace tandem
