/// Scenes of the corpus as glTF files.
#pragma once

#include <string>

#include "tandem/scene/scene.h"

namespace tandem::hard {

/// The scene as the text of a .gltf file: spheres and boxes by EXT_implicit_geometry, all numbers so that they read
/// back as the same bits. Throws std::logic_error for what the corpus has not: instances and animation, which glTF
/// keeps in float.
[[nodiscard]] std::string to_gltf(const Scene& scene);

}  // namespace tandem::hard
