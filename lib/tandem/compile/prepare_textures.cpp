#include "tandem/compile/prepare_textures.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "tandem/base/error.h"
#include "tandem/images/levels.h"
#include "tandem/math/exact_math.h"
#include "tandem/scene/corner_slots.h"

namespace tandem {

namespace {

constexpr std::size_t most_texels = std::size_t{1} << 30;

constexpr std::uint32_t rgb = 0x00FFFFFF;  // the bits of a texel's red, green and blue
constexpr std::uint32_t green_blue = 0x00FFFF00;

float level_of(std::uint32_t channel) { return static_cast<float>(channel & 255U) / 255.0F; }

/// Of the channels in `bits`.
bool has_one_colour(const Image& image, std::uint32_t bits = ~0U) {
    return std::all_of(image.texels.begin(), image.texels.end(),
                       [&](std::uint32_t t) { return (t & bits) == (image.texels[0] & bits); });
}

struct AlphaRange {
    std::uint32_t least = 255, most = 0;
};
AlphaRange alphas(const Image& image) {
    AlphaRange range;
    for (const std::uint32_t texel : image.texels) {
        range.least = std::min(range.least, texel >> 24);
        range.most = std::max(range.most, texel >> 24);
    }
    return range;
}

TextureUse with_transform(const TextureReference& reference, std::uint32_t texture, const CornerSlots& slots) {
    const float cosine = exact_cos(reference.rotation);
    const float sine = exact_sin(reference.rotation);
    const Vec2f& scale = reference.scale;
    return {texture,
            {cosine * scale.x, sine * scale.y, reference.offset.x},
            {-sine * scale.x, cosine * scale.y, reference.offset.y},
            slots.slot_of(reference.texcoord)};
}

bool has_picture(const MaterialTextures& m) {
    return m.diffuse.texture != no_texture || m.normal.texture != no_texture || m.emission.texture != no_texture ||
           m.metallic_roughness.texture != no_texture || m.colour_slot != no_slot;
}

class TexturePreparer {
  public:
    TexturePreparer(const Scene& scene, PreparedScene& prepared)
        : scene_(scene),
          prepared_(prepared),
          phong_(prepared.materials),
          optics_(prepared.optics),
          microfacets_(prepared.microfacets),
          anisotropies_(prepared.anisotropies),
          slots_(corner_slots(scene)) {
        result_.levels = texture_levels();
    }

    void run() {
        for (std::size_t i = 0; i < scene_.materials.size(); ++i) add(i);
        if (std::none_of(microfacets_.begin(), microfacets_.end(), [](const auto& m) { return m.anisotropy > 0; })) {
            anisotropies_.clear();
        }
        bool needed = false;
#define TANDEM_PART_TEXTURE(part, needs, name, names, space, is) needed = keep_if_used(prepared_.names) || needed;
#include "tandem/kernel/bsdf/lobes.def"
        needed = needed ||
                 std::any_of(result_.materials.begin(), result_.materials.end(),
                             [](const auto& m) { return has_picture(m) || m.alpha_cutoff > 0; }) ||
                 std::any_of(anisotropies_.begin(), anisotropies_.end(),
                             [](const auto& a) { return a.texture.texture != no_texture; });
        if (needed) prepared_.textures = std::move(result_);
    }

  private:
    void add(std::size_t index) {
        const Material& material = scene_.materials[index];
        const CornerSlots& slots = slots_[index];
        MaterialTextures prepared;
        if (slots.has_colours) prepared.colour_slot = slots.colour_slot();
        AlphaRange alpha = {255, 255};  // of the texture
        if (material.alpha_mode == AlphaMode::mask) {
            prepared.alpha = material.alpha;
            prepared.alpha_cutoff = material.alpha_cutoff;
        }
        if (material.diffuse_texture) {
            const TextureReference& reference = *material.diffuse_texture;
            const Image& image = image_of(reference);
            const Facts& facts = facts_of(image);
            const bool one_colour = facts.has_one_rgb;
            if (one_colour) {
                const Vec3f factor = colour_of(image.texels[0]);
                phong_[index].diffuse *= factor;
                phong_[index].ambient *= factor;
            }
            if (facts.has_one_rgba) {
                prepared.alpha *= level_of(image.texels[0] >> 24);
            } else if (!one_colour || prepared.alpha_cutoff > 0) {
                if (prepared.alpha_cutoff > 0) alpha = facts.alpha;
                prepared.diffuse = with_transform(reference, add(reference, ColourSpace::srgb, one_colour), slots);
            }
        }
        // more than the rounding of the kernels' product
        const double cutoff = prepared.alpha_cutoff, rounding = 1e-6;
        result_.is_masked_out.push_back(double{prepared.alpha} * (alpha.most / 255.0) < cutoff * (1 - rounding));
        if (!slots.has_colours && double{prepared.alpha} * (alpha.least / 255.0) > cutoff * (1 + rounding)) {
            prepared.alpha = 1;
            prepared.alpha_cutoff = 0;
        }
        if (material.normal_texture) {
            const TextureReference& reference = *material.normal_texture;
            prepared.normal = with_transform(reference, add(reference, ColourSpace::linear, false), slots);
            prepared.normal_scale = material.normal_scale;
        }
        if (material.emissive_texture) add_emission(*material.emissive_texture, slots, index, prepared);
        if (material.metallic_roughness_texture && !microfacets_.empty() && microfacets_[index].is_there != 0) {
            add_metallic_roughness(*material.metallic_roughness_texture, slots, index, prepared);
        }
        result_.materials.push_back(prepared);
        anisotropies_.emplace_back();
        if (is_anisotropic(material)) add_anisotropy(material, slots, index);
#define TANDEM_PART_TEXTURE(part, needs, name, names, space, is) \
    prepared_.names.push_back(use_of(material.part && !material.unlit, material.name, ColourSpace::space, slots));
#include "tandem/kernel/bsdf/lobes.def"
    }

    TextureUse use_of(bool has_part, const std::optional<TextureReference>& reference, ColourSpace space,
                      const CornerSlots& slots) {
        if (!has_part || !reference) return {};
        return with_transform(*reference, add(*reference, space, false), slots);
    }

    /// Clears the textures of all materials if no material has one.
    static bool keep_if_used(std::vector<TextureUse>& uses) {
        const bool used =
            std::any_of(uses.begin(), uses.end(), [](const TextureUse& use) { return use.texture != no_texture; });
        if (!used) uses.clear();
        return used;
    }

    /// Facts about all texels of an image.
    struct Facts {
        bool has_one_rgb, has_one_rgba;
        AlphaRange alpha;
    };
    /// Cached, because many materials may use one image.
    const Facts& facts_of(const Image& image) {
        const auto known = facts_.find(&image);
        if (known != facts_.end()) return known->second;
        return facts_[&image] = {has_one_colour(image, rgb), has_one_colour(image), alphas(image)};
    }

    const Image& image_of(const TextureReference& reference) const {
        return scene_.images[scene_.textures[reference.texture].image];
    }

    void add_emission(const TextureReference& reference, const CornerSlots& slots, std::size_t index,
                      MaterialTextures& prepared) {
        Vec3f& emission = optics_[index].emission;
        if (!(norm1(emission) > 0)) return;
        const Image& image = image_of(reference);
        if (facts_of(image).has_one_rgb) {
            emission *= colour_of(image.texels[0]);
        } else {
            prepared.emission = with_transform(reference, add(reference, ColourSpace::srgb, false), slots);
        }
    }

    /// Green and blue only: red often holds something else, such as occlusion.
    void add_metallic_roughness(const TextureReference& reference, const CornerSlots& slots, std::size_t index,
                                MaterialTextures& prepared) {
        const Image& image = image_of(reference);
        if (has_one_colour(image, green_blue)) {
            microfacets_[index].roughness *= level_of(image.texels[0] >> 8);
            microfacets_[index].metallic *= level_of(image.texels[0] >> 16);
        } else {
            prepared.metallic_roughness = with_transform(reference, add(reference, ColourSpace::linear, false), slots);
        }
    }

    void add_anisotropy(const Material& material, const CornerSlots& slots, std::size_t index) {
        Microfacets& facets = microfacets_[index];
        Anisotropy& anisotropy = anisotropies_[index];
        anisotropy.x = exact_cos(facets.rotation);
        anisotropy.y = exact_sin(facets.rotation);
        anisotropy.slot = slots.slot_of(tangent_set(material));
        if (!material.anisotropy_texture) return;
        const TextureReference& reference = *material.anisotropy_texture;
        const Image& image = image_of(reference);
        if (has_one_colour(image, rgb)) {
            const Rgba<float> texel = {level_of(image.texels[0]), level_of(image.texels[0] >> 8), 1, 1};
            const Vec3d direction = rough_tangent<float>(anisotropy, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, texel);
            anisotropy.x = static_cast<float>(direction.x);
            anisotropy.y = static_cast<float>(direction.y);
            facets.anisotropy *= level_of(image.texels[0] >> 16);
        } else {
            anisotropy.texture = with_transform(reference, add(reference, ColourSpace::linear, false), slots);
        }
    }

    /// Linear.
    Vec3f colour_of(std::uint32_t texel) const {
        return {result_.levels[texel & 255U], result_.levels[texel >> 8 & 255U], result_.levels[texel >> 16 & 255U]};
    }

    /// Index of the descriptor. `whitened`: all colours are white, only alpha remains.
    std::uint32_t add(const TextureReference& reference, ColourSpace space, bool whitened) {
        const auto [known, is_new] =
            descriptor_of_.try_emplace({reference.texture, space}, static_cast<std::uint32_t>(result_.textures.size()));
        if (is_new) {
            const Texture& texture = scene_.textures[reference.texture];
            const Image& image = image_of(reference);
            const bool one = facts_of(image).has_one_rgba;
            result_.textures.push_back({first_texel_of(texture.image, whitened), one ? 1 : image.width,
                                        one ? 1 : image.height, texture.wrap_s, texture.wrap_t, texture.filter, space});
        }
        return known->second;
    }

    std::uint32_t first_texel_of(std::uint32_t index, bool whitened) {
        const auto [known, is_new] =
            first_texel_of_.try_emplace({index, whitened}, static_cast<std::uint32_t>(result_.texels.size()));
        if (is_new) {
            const Image& image = scene_.images[index];
            const std::size_t count = facts_of(image).has_one_rgba ? 1 : image.texels.size();
            if (count > most_texels - result_.texels.size()) {
                throw InputError("the textures of the scene have more than 2^30 texels; make their images smaller");
            }
            result_.texels.insert(result_.texels.end(), image.texels.begin(),
                                  image.texels.begin() + static_cast<std::ptrdiff_t>(count));
            if (whitened) {
                std::for_each(result_.texels.end() - static_cast<std::ptrdiff_t>(count), result_.texels.end(),
                              [](std::uint32_t& texel) { texel |= rgb; });
            }
        }
        return known->second;
    }

    const Scene& scene_;
    PreparedScene& prepared_;
    std::vector<PhongMaterial>& phong_;
    std::vector<Optics>& optics_;
    std::vector<Microfacets>& microfacets_;
    std::vector<Anisotropy>& anisotropies_;
    std::vector<CornerSlots> slots_;                                                 ///< by material
    std::map<std::tuple<std::uint32_t, ColourSpace>, std::uint32_t> descriptor_of_;  ///< by texture and use
    std::map<const Image*, Facts> facts_;
    std::map<std::pair<std::uint32_t, bool>, std::uint32_t> first_texel_of_;  ///< by image, and whether whitened
    PreparedTextures result_;
};

}  // namespace

TextureSet view(const PreparedTextures& textures) {
    if (textures.materials.empty()) return {nullptr, nullptr, nullptr, nullptr};
    return {textures.texels.data(), textures.textures.data(), textures.materials.data(), textures.levels.data()};
}

bool has_texture(const PreparedTextures& textures, std::size_t material) {
    if (textures.materials.empty()) return false;
    return has_picture(textures.materials[material]);
}

bool has_colours(const PreparedTextures& textures, const TextureUse& use) {
    if (use.texture == no_texture) return false;
    const TextureDescriptor& of = textures.textures[use.texture];
    const auto first = textures.texels.begin() + of.first_texel;
    return !std::all_of(first, first + std::int64_t{of.width} * of.height,
                        [](std::uint32_t t) { return (t & rgb) == rgb; });
}

void prepare_textures(const Scene& scene, PreparedScene& prepared) { TexturePreparer(scene, prepared).run(); }

}  // namespace tandem
