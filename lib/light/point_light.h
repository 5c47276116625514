/// The point light.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// World space, metres. `intensity`: RGB; Phong materials see it without fall-off, as in the paper.
struct PointLight {
    Vec3f position;
    Vec3f intensity;
};

}  // namespace tandem
