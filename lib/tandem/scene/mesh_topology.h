/// The topology of a mesh.
#pragma once

#include "tandem/scene/scene.h"

namespace tandem {

/// Do the faces enclose a volume, with their fronts outward? From outside no ray then hits a back face. Vertices at the
/// same position count as one, so seams of texture coordinates and normals do not open a mesh. Every edge must be
/// walked as often in one direction as in the other. Time n log n in the number of faces.
[[nodiscard]] bool is_closed(const Mesh& mesh);

}  // namespace tandem
