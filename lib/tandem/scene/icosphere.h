/// A triangulated sphere.
#pragma once

#include "tandem/scene/scene.h"

namespace tandem {

/// The unit sphere as an icosahedron whose 20 faces are divided into four `level` times (0 to 10). The mesh is closed,
/// its faces share vertices, the vertices have normals, and the fronts are outside.
[[nodiscard]] Mesh icosphere(int level);

}  // namespace tandem
