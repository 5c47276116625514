/// The textures of a scene, as kernels read them.
#pragma once

#include <cstddef>
#include <vector>

#include "tandem/kernel/texture/texture_set.h"

namespace tandem {

/// The arrays of a TextureSet. All are empty if no material has a texture or an alpha mask.
struct PreparedTextures {
#define TANDEM_TEXTURE_ARRAY(Type, names) std::vector<Type> names;
#include "tandem/kernel/texture/texture_arrays.def"
#undef TANDEM_TEXTURE_ARRAY
    /// By material, if any has textures: whether its alpha is below its cutoff everywhere. No kernel reads this.
    std::vector<bool> is_masked_out;
};

/// The kernels' view of the arrays, which must outlive it.
[[nodiscard]] TextureSet view(const PreparedTextures& textures);

/// Whether the shading of this material depends on the texture coordinates.
[[nodiscard]] bool has_texture(const PreparedTextures& textures, std::size_t material);

/// Whether a texture contains any colour but white.
[[nodiscard]] bool has_colours(const PreparedTextures& textures, const TextureUse& use);

}  // namespace tandem
