/// The oracle's own background, in extended precision.
#pragma once

#include "tandem/oracle/oracle_geometry.h"

namespace tandem::oracle {

/// Is it a picture?
[[nodiscard]] bool has_picture(const SceneView& scene);

/// What is seen along a direction of any length: the gradient, or the picture in its place.
[[nodiscard]] Vector background_towards(const SceneView& scene, const Vector& direction);

}  // namespace tandem::oracle
