/// Pictures on surfaces, as an author says them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tandem/kernel/texture/texel_axis.h"
#include "tandem/math/vec.h"

namespace tandem {

/// A picture: decoded from a file (read_texels() in images/texels.h, or the importer) or made in memory.
struct Image {
    std::string name{};
    std::uint32_t width = 0, height = 0;  ///< from 1 to 16384
    /// Row by row from the top: red in the lowest 8 bits, then green, blue and alpha, which does not multiply the
    /// others. What is used as a colour is sRGB, and what is used as a normal is linear.
    std::vector<std::uint32_t> texels{};
};

/// A picture and how it is looked up. There are no mipmaps.
struct Texture {
    std::uint32_t image = 0;  ///< index into Scene::images
    Wrap wrap_s = Wrap::repeat;
    Wrap wrap_t = Wrap::repeat;
    Filter filter = Filter::linear;
};

/// A texture (index into Scene::textures) as a material uses it, at the coordinates (u, v) of the surface, scaled, then
/// turned around (0, 0), from u towards -v for a positive angle, then moved: those of KHR_texture_transform.
struct TextureReference {
    std::uint32_t texture = 0;
    Vec2f offset{0, 0};
    float rotation = 0;  ///< radians
    Vec2f scale{1, 1};
    std::uint32_t texcoord = 0;  ///< which of a mesh's sets of coordinates; other shapes have one
};

/// mask: where alpha is below Material::alpha_cutoff, there is no surface.
enum class AlphaMode { opaque, mask };

}  // namespace tandem
