/// Reads textures and alpha masks of materials.
#pragma once

#include "tandem/gltf/buffers.h"
#include "tandem/gltf/report.h"
#include "tandem/scene/scene.h"

namespace tandem::gltf {

/// Adds textures and alpha to the materials of `scene`, which are those of the file in its order, and reads the images
/// that they use; others are noted but not opened. alphaMode BLEND becomes MASK with a cutoff of 0.5. A texture whose
/// image cannot be read is left out. If the images have more texels than a file of that size may have, the largest are
/// halved until they fit.
void read_textures(const Source& source, Scene& scene, ImportReport& report, FlawLog& flaws);

}  // namespace tandem::gltf
