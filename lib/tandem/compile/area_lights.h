/// Finds the area lights of a scene.
#pragma once

#include "tandem/compile/prepared_scene.h"

namespace tandem {

/// Fills area_lights with the emissive spheres, triangles and quads. Seven eighths of the probability are in proportion
/// to area times the sum of the colour channels, and one eighth is shared equally, so that a weak light is still chosen
/// next to a far stronger one. Emissive boxes, ellipsoids and parallelepipeds are not sampled: paths find them, with
/// indirect light.
void find_area_lights(PreparedScene& scene);

}  // namespace tandem
