/// Which primitives are lights with an area.
#pragma once

#include "tandem/compile/prepared_scene.h"

namespace tandem {

/// Fills area_lights with the spheres, triangles and quads whose material glows. Seven eighths of the chances are in
/// proportion to area times the sum of the colours, and one eighth is shared equally, so that a weak light is chosen
/// beside one that is far stronger. Boxes, ellipsoids and parallelepipeds that glow are not among them: paths find
/// them, with indirect light.
void find_area_lights(PreparedScene& scene);

}  // namespace tandem
