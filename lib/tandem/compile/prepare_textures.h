/// From authored textures to flat arrays.
#pragma once

#include <vector>

#include "tandem/compile/prepared_textures.h"
#include "tandem/kernel/texture/anisotropy.h"
#include "tandem/scene/scene.h"

namespace tandem {

/// The textures of the materials of a valid scene, without what costs and changes nothing: a texture of
/// one colour becomes a factor of `phong`, `optics` or `microfacets`, which go by index of the material; a normal map
/// of one colour becomes one texel; the colours of a picture that differs in alpha alone become white, and a factor; a
/// mask that lets everything through is none; and pictures that nothing shows are left out. `anisotropies` becomes one
/// for each material, or none if no microfacets are anisotropic. Throws InputError if there are more than 2^30 texels.
[[nodiscard]] PreparedTextures prepare_textures(const Scene& scene, std::vector<PhongMaterial>& phong,
                                                std::vector<Optics>& optics, std::vector<Microfacets>& microfacets,
                                                std::vector<Anisotropy>& anisotropies);

}  // namespace tandem
