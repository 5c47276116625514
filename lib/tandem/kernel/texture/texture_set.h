/// The textures of a scene as flat arrays, and their assignment to materials.
#pragma once

#include "tandem/kernel/texture/texture_view.h"

namespace tandem {

inline constexpr std::uint32_t no_texture = 0xFFFFFFFFU;
inline constexpr std::uint32_t no_slot = 0xFFFFFFFFU;

/// The encoding of red, green and blue, which follows from the use of a texture.
enum class ColourSpace : std::uint32_t { srgb, linear };

/// A texture in the arrays of a TextureSet.
struct TextureDescriptor {
    std::uint32_t first_texel = 0;
    std::uint32_t width = 1, height = 1;
    Wrap wrap_s = Wrap::repeat, wrap_t = Wrap::repeat;
    Filter filter = Filter::linear;
    ColourSpace space = ColourSpace::srgb;
};

/// A texture of a material, and the transform from the surface's coordinates to the texture's: u is u_row . (u, v, 1).
/// The corners of a face have several slots of coordinates; `slot` is that of the texture. Other primitives have a
/// single parametrisation.
struct TextureUse {
    std::uint32_t texture = no_texture;
    float u_row[3] = {1, 0, 0};
    float v_row[3] = {0, 1, 0};
    std::uint32_t slot = 0;
};

/// The textures of one material. Its alpha is `alpha` times that of the base colour (kernel/corner_values.h); where
/// that is below `alpha_cutoff`, the surface is masked out. A cutoff of 0 masks nothing.
struct MaterialTextures {
    TextureUse diffuse;             ///< base colour: multiplies the diffuse and the ambient reflectance
    TextureUse normal;              ///< normals in the frame of the surface: normal_map.h
    TextureUse emission;            ///< multiplies the emission
    TextureUse metallic_roughness;  ///< green multiplies the roughness of microfacets, blue their metalness
    float normal_scale = 1;
    float alpha = 1;
    float alpha_cutoff = 0;
    /// Vertex colours of faces: red and green in this slot, blue and alpha in the next. They multiply the base colour.
    std::uint32_t colour_slot = no_slot;
};
static_assert(sizeof(MaterialTextures) == 144 && sizeof(TextureDescriptor) == 28,
              "no padding: scene_hash() reads all bytes");

/// Whether the material reads vertex colours, or texture coordinates of another slot than 0.
TANDEM_HD_INLINE bool reads_several_slots(const MaterialTextures& material) {
    return material.colour_slot != no_slot || (material.diffuse.slot | material.normal.slot | material.emission.slot |
                                               material.metallic_roughness.slot) != 0;
}

/// Pointers are to memory of the host or the device, whichever reads them.
struct TextureSet {
#define TANDEM_TEXTURE_ARRAY(Type, names) const Type* names;
#include "tandem/kernel/texture/texture_arrays.def"
#undef TANDEM_TEXTURE_ARRAY
};

TANDEM_HD_INLINE bool has_textures(const TextureSet& set) { return set.materials != nullptr; }

TANDEM_HD_INLINE TextureView texture_view(const TextureSet& set, std::uint32_t texture) {
    const TextureDescriptor& d = set.textures[texture];
    return {set.texels + d.first_texel,
            set.levels + (d.space == ColourSpace::srgb ? 0 : 256),
            d.width,
            d.height,
            d.wrap_s,
            d.wrap_t,
            d.filter};
}

/// Looks up a texture of a material at the coordinates (u, v) of its surface; white without a texture.
template <class Real>
TANDEM_HD_CALL Rgba<Real> sample(const TextureSet& set, const TextureUse& use, Double<Real> u, Double<Real> v) {
    using D = Double<Real>;
    if (use.texture == no_texture) return {Real(1.0F), Real(1.0F), Real(1.0F), Real(1.0F)};
    const auto along = [&](const float* row) { return (D(row[0]) * u + D(row[1]) * v) + D(row[2]); };
    return sample<Real>(texture_view(set, use.texture), along(use.u_row), along(use.v_row));
}

/// The product of two alphas. It is a float in every tier, like the cutoff: an alpha of k / 255 with a cutoff of k /
/// 255 is opaque.
template <class Real>
TANDEM_HD_INLINE Real times_alpha(const Real& a, const Real& b) {
    const Float<Real> product = narrow(a) * narrow(b);
    if constexpr (std::is_same_v<Real, Float<Real>>) {
        return product;
    } else {
        return widen(product);
    }
}

/// The lanes in which the material is opaque, given the alpha of its base colour.
template <class Real>
TANDEM_HD_INLINE Mask<Real> is_opaque(const MaterialTextures& material, const Real& alpha) {
    return times_alpha(Real(material.alpha), alpha) >= Real(material.alpha_cutoff);
}

}  // namespace tandem
