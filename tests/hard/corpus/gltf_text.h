/// Scenes of the corpus as glTF files.
#pragma once

#include <string>

#include "tandem/scene/scene.h"

namespace tandem::hard {

/// Whether glTF can represent the scene: it has no quadrilaterals.
[[nodiscard]] bool fits_gltf(const Scene& scene);

/// The scene as the text of a .gltf file: spheres and boxes by EXT_implicit_geometry, embedded meshes, and numbers that
/// read back as the same bits. Throws std::logic_error for what the corpus does not use or fits_gltf() excludes:
/// instances and animation, which glTF stores in float; normals and texture coordinates.
[[nodiscard]] std::string to_gltf(const Scene& scene);

}  // namespace tandem::hard
