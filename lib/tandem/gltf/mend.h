/// Repairs meshes with invalid numbers.
#pragma once

#include <string>

#include "tandem/gltf/document.h"
#include "tandem/scene/scene.h"

namespace tandem::gltf {

/// Makes the mesh of a primitive at `path` valid, with notes. Leaves out triangles with a vertex whose position is not
/// finite or beyond 1e18; replaces such normals by the mean normal of their triangles, and texture coordinates that are
/// not finite by (0, 0). Throws a Flaw if no triangle is left.
void mend(const Document& document, Mesh& mesh, const std::string& path, FlawLog& flaws);

}  // namespace tandem::gltf
