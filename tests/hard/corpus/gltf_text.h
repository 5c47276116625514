/// Scenes of the corpus as glTF files.
#pragma once

#include <string>

#include "tandem/scene/scene.h"

namespace tandem::hard {

/// Can glTF hold the scene? It has no quadrilaterals.
[[nodiscard]] bool fits_gltf(const Scene& scene);

/// The scene as the text of a .gltf file: spheres and boxes by EXT_implicit_geometry, meshes in the file itself, all
/// numbers so that they read back as the same bits. Throws std::logic_error for what the corpus has not, or fits_gltf()
/// denies: instances and animation, which glTF keeps in float; normals and texture coordinates.
[[nodiscard]] std::string to_gltf(const Scene& scene);

}  // namespace tandem::hard
