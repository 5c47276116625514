/// Textures of materials, and what is cut out of surfaces.
#pragma once

#include "tandem/gltf/model.h"
#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem::gltf {

/// Gives the materials of `scene`, which are those of the file in its order, their base colour and normal textures and
/// their alpha, and reads the images that these show; others are not opened, and noted. alphaMode BLEND becomes MASK at
/// 0.5. Throws InputError for an image that cannot be read, and for more than 2^28 texels.
void read_textures(const Source& source, Scene& scene, ImportReport& report);

}  // namespace tandem::gltf
