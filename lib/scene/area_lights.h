/// Which primitives are lights with an area.
#pragma once

#include "tandem/scene/prepared_scene.h"

namespace tandem {

/// Fills area_lights with the spheres, triangles and quads whose material glows, each with a chance in proportion to
/// its area times the sum of its colours. Boxes, ellipsoids and parallelepipeds that glow are not among them: paths
/// find them, with indirect light.
void find_area_lights(PreparedScene& scene);

}  // namespace tandem
