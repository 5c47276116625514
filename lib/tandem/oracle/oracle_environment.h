/// The oracle's own background, in extended precision.
#pragma once

#include "tandem/oracle/oracle_geometry.h"

namespace tandem::oracle {

/// Whether the background is a picture.
[[nodiscard]] bool has_picture(const SceneView& scene);

/// The radiance of the gradient or the picture along a direction of any length.
[[nodiscard]] Vector background_towards(const SceneView& scene, const Vector& direction);

}  // namespace tandem::oracle
