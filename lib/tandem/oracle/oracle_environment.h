/// The oracle's own background, in extended precision.
#pragma once

#include "tandem/oracle/oracle_geometry.h"

namespace tandem::oracle {

/// The radiance of the background along a direction of any length.
[[nodiscard]] Vector background_towards(const SceneView& scene, const Vector& direction);

}  // namespace tandem::oracle
