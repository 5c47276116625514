/// Textures of materials, and what is cut out of surfaces.
#pragma once

#include "tandem/gltf/buffers.h"
#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem::gltf {

/// Gives the materials of `scene`, which are those of the file in its order, their textures and their
/// alpha, and reads the images that these show; others are not opened, and noted. alphaMode BLEND becomes MASK at
/// 0.5. A material is without a texture whose image cannot be read. Where the images have more texels than a file of
/// that size may bring, the largest are halved until they fit.
void read_textures(const Source& source, Scene& scene, ImportReport& report, FlawLog& flaws);

}  // namespace tandem::gltf
