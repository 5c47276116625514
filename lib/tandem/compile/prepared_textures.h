/// The textures of a scene as the kernels read them.
#pragma once

#include <cstddef>
#include <vector>

#include "tandem/kernel/texture/texture_set.h"

namespace tandem {

/// The arrays of a TextureSet. All are empty where no material has a texture or is cut out.
struct PreparedTextures {
#define TANDEM_TEXTURE_ARRAY(Type, names) std::vector<Type> names;
#include "tandem/kernel/texture/texture_arrays.def"
#undef TANDEM_TEXTURE_ARRAY
    /// By material, if any has textures: whether its alpha is below its cutoff everywhere. No kernel reads this.
    std::vector<bool> is_masked_out;
};

/// The window of the kernels onto the arrays, which must outlive it.
[[nodiscard]] TextureSet view(const PreparedTextures& textures);

/// Does the picture of this material depend on where a point lies on its surface?
[[nodiscard]] bool has_texture(const PreparedTextures& textures, std::size_t material);

/// Does a picture show anything but white?
[[nodiscard]] bool has_colours(const PreparedTextures& textures, const TextureUse& use);

}  // namespace tandem
