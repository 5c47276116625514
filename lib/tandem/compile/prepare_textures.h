/// Turns authored textures into flat arrays.
#pragma once

#include <vector>

#include "tandem/compile/prepared_textures.h"
#include "tandem/kernel/texture/anisotropy.h"
#include "tandem/scene/scene.h"

namespace tandem {

/// The textures of the materials of a valid scene, simplified where the image stays the same. A texture of one colour
/// becomes a factor of `phong`, `optics` or `microfacets` (indexed by material); a normal map of one colour becomes one
/// texel; an image that varies in alpha only becomes white with a factor; a mask that is opaque everywhere is removed;
/// and images that nothing uses are left out. `anisotropies` gets one entry per material, or none if no microfacets are
/// anisotropic. Throws InputError if there are more than 2^30 texels.
[[nodiscard]] PreparedTextures prepare_textures(const Scene& scene, std::vector<PhongMaterial>& phong,
                                                std::vector<Optics>& optics, std::vector<Microfacets>& microfacets,
                                                std::vector<Anisotropy>& anisotropies);

}  // namespace tandem
