/// Authored textures.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tandem/kernel/texture/texel_axis.h"
#include "tandem/math/vec.h"

namespace tandem {

/// An image: decoded from a file (read_texels() in images/texels.h, or the importer) or made in memory.
struct Image {
    std::string name{};
    std::uint32_t width = 0, height = 0;  ///< from 1 to 16384
    /// Row by row from the top: red in the lowest 8 bits, then green, blue and alpha, not premultiplied. Colours are
    /// sRGB, normals are linear.
    std::vector<std::uint32_t> texels{};
};

/// An image and how it is sampled. There are no mipmaps.
struct Texture {
    std::uint32_t image = 0;  ///< index into Scene::images
    Wrap wrap_s = Wrap::repeat;
    Wrap wrap_t = Wrap::repeat;
    Filter filter = Filter::linear;
};

/// A material's use of a texture (index into Scene::textures). The coordinates (u, v) of the surface are scaled, then
/// rotated around (0, 0), from u towards -v for a positive angle, then translated, as in KHR_texture_transform.
struct TextureReference {
    std::uint32_t texture = 0;
    Vec2f offset{0, 0};
    float rotation = 0;  ///< radians
    Vec2f scale{1, 1};
    std::uint32_t texcoord = 0;  ///< which of a mesh's sets of coordinates; other shapes have one
};

/// mask: where alpha is below Material::alpha_cutoff, the surface is removed.
enum class AlphaMode { opaque, mask };

}  // namespace tandem
