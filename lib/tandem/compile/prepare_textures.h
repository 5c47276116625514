/// Turns authored textures into flat arrays.
#pragma once

#include "tandem/compile/prepared_scene.h"
#include "tandem/scene/scene.h"

namespace tandem {

/// Fills `prepared.textures` from the materials of a valid scene, simplified where the image stays the same. A texture
/// of one colour becomes a factor of `materials`, `optics` or `microfacets` of `prepared`, which are there already; a
/// normal map of one colour becomes one texel; an image that varies in alpha only becomes white with a factor; a mask
/// that is opaque everywhere is removed; and images that nothing uses are left out. `anisotropies` gets one entry per
/// material, or none if no microfacets are anisotropic; so do the textures of optional parts. Throws InputError if
/// there are more than 2^30 texels.
void prepare_textures(const Scene& scene, PreparedScene& prepared);

}  // namespace tandem
