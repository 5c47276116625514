/// The topology of a mesh.
#pragma once

#include "tandem/scene/scene.h"

namespace tandem {

/// Whether the faces enclose a volume, with their fronts outward. Then no ray from outside hits a back face. Vertices
/// at the same position count as one, so seams of texture coordinates and normals do not open a mesh. Every edge must
/// occur as often in one direction as in the other. O(n log n) in the number of faces.
[[nodiscard]] bool is_closed(const Mesh& mesh);

}  // namespace tandem
