/// Numbers of a mesh that stand for nothing.
#pragma once

#include <string>

#include "tandem/gltf/document.h"
#include "tandem/scene/scene.h"

namespace tandem::gltf {

/// Makes the mesh of a primitive at `path` a valid one, with notes: leaves out triangles with a vertex whose position
/// is not a number up to 1e18; gives vertices whose normal is no such number the mean normal of their triangles, and
/// those whose texture coordinates are not finite (0, 0). Throws a Flaw if no triangle is left.
void mend(const Document& document, Mesh& mesh, const std::string& path, FlawLog& flaws);

}  // namespace tandem::gltf
