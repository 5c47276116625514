/// A sphere of triangles.
#pragma once

#include "tandem/scene/scene.h"

namespace tandem {

/// The unit sphere as an icosahedron whose 20 faces are divided into four `level` times (0 to 10); closed, with shared
/// vertices on the sphere, normals, and front outside.
[[nodiscard]] Mesh icosphere(int level);

}  // namespace tandem
