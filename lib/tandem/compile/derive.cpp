#include "tandem/compile/derive.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "tandem/math/fp_environment.h"
#include "tandem/scene/motion.h"

namespace tandem {

namespace {

/// "material 'glass'", or with its number if it has no name.
std::string label(const char* what, const std::string& name, std::size_t index) {
    return name.empty() ? fmt::format("{} {}", what, index) : fmt::format("{} '{}'", what, name);
}

/// Keeps the first reason for each effect, and counts the others.
class Needs {
  public:
    void add(Effect effect, const std::string& reason) {
        const auto [place, is_new] = found_.try_emplace(effect, Need{reason, 0});
        if (!is_new) ++place->second.others;
    }
    [[nodiscard]] std::vector<EffectNeed> take() const {
        std::vector<EffectNeed> needs;
        for (const auto& [effect, need] : found_) {
            needs.push_back(
                {effect, need.others == 0 ? need.reason : fmt::format("{}, and {} more", need.reason, need.others)});
        }
        return needs;
    }

  private:
    struct Need {
        std::string reason;
        std::size_t others;
    };
    std::map<Effect, Need> found_;
};

std::vector<bool> used_materials(const Scene& scene, const PreparedScene& prepared) {
    std::vector<bool> used(scene.materials.size(), false);
    // millions of neighbours may have the same material
    const std::vector<std::uint32_t>& material_of = prepared.material_of;
    for (std::size_t i = 0; i < material_of.size(); ++i) {
        if (i == 0 || material_of[i] != material_of[i - 1]) used[material_of[i]] = true;
    }
    for (const auto& mesh : prepared.instances.meshes) used[mesh.material] = true;
    return used;
}

void add_light(const LightSource& light, const std::string& name, Needs& needs) {
    if (light.casts_shadows) needs.add(Effect::shadows, name + " casts shadows");
    if (light.kind == LightKind::spot) needs.add(Effect::spot_lights, name + " is a spot light");
    if (light.kind == LightKind::directional) {
        needs.add(Effect::directional_lights, name + " is a directional light");
    } else if (light.inverse_square) {
        needs.add(Effect::inverse_square, name + " falls off with distance");
    }
}

/// `coloured`: caches has_colours() by the number of the texture, since many materials may share one.
void add_pictures(const PreparedTextures& textures, std::size_t material, const std::string& name,
                  std::map<std::uint32_t, bool>& coloured, Needs& needs) {
    if (textures.materials.empty()) return;
    const MaterialTextures& of_material = textures.materials[material];
    const auto [known, is_new] = coloured.try_emplace(of_material.diffuse.texture, false);
    if (is_new) known->second = has_colours(textures, of_material.diffuse);
    if (known->second) needs.add(Effect::textures, name + " has a texture");
    if (has_colours(textures, of_material.emission)) needs.add(Effect::textures, name + " has an emissive texture");
    if (has_colours(textures, of_material.metallic_roughness))
        needs.add(Effect::textures, name + " has a metallic-roughness texture");
    if (of_material.colour_slot != no_slot) needs.add(Effect::textures, name + " has vertex colours");
    if (of_material.normal.texture != no_texture) needs.add(Effect::normal_maps, name + " has a normal map");
    if (of_material.alpha_cutoff > 0) needs.add(Effect::cutouts, name + " has an alpha mask");
}

void add_surroundings(const Scene& scene, const PreparedScene& prepared, Needs& needs) {
    if (scene.indirect_light) needs.add(Effect::indirect, "the scene asks for indirect light");
    if (prepared.roulette_from != PreparedScene::never) {
        needs.add(Effect::roulette, "paths of indirect light may be long");
    }
    if (scene.environment.illuminates != 0) {
        needs.add(Effect::environment_light, "the environment lights surfaces");
        const bool by_samples = !scene.indirect_light || has_environment(scene);
        const bool by_shadow_rays = by_samples && prepared.area_light_shadows;
        if (by_shadow_rays) needs.add(Effect::shadows, "the environment casts shadows");
    }
    if (prepared.camera.lens.aperture_radius > 0 && !prepared.camera.orthographic) {
        needs.add(Effect::lens,
                  fmt::format("the camera has an aperture of radius {:g} m", prepared.camera.lens.aperture_radius));
    }
}

void add_motion(const Scene& scene, const PreparedScene& prepared, Needs& needs) {
    const Shutter& shutter = prepared.shutter;
    if (!is_open(shutter)) return;
    const std::size_t camera = prepared.camera_node;
    const std::string opens =
        fmt::format("{} has its shutter open for {:g} s, during which ",
                    label("camera", scene.nodes[camera].name, camera), shutter.close - shutter.open);
    for (const std::size_t node : nodes_in_motion(scene, camera, prepared.time)) {
        const std::string what = node == camera ? "it" : label("node", scene.nodes[node].name, node);
        needs.add(Effect::motion_blur, opens + what + " moves");
    }
}

/// " (metallic 1, roughness 0.5)": those that are not 0.
template <class Part>
std::string numbers_of(const Part& part) {
    std::string text;
    Part::visit_numbers(part, [&](const char* name, const auto& value, float, float) {
        if (value == std::decay_t<decltype(value)>{}) return;
        text += fmt::format("{}{} ", text.empty() ? " (" : ", ", name);
        if constexpr (std::is_same_v<decltype(value), const float&>) {
            text += fmt::format("{:g}", value);
        } else {
            text += fmt::format("{:g} {:g} {:g}", value.x, value.y, value.z);
        }
    });
    return text.empty() ? text : text + ")";
}

void add_anisotropy(const PreparedScene& prepared, std::size_t material, const std::string& name, Needs& needs) {
    if (prepared.anisotropies.empty()) return;
    const float strength = prepared.microfacets[material].anisotropy;
    if (!(strength > 0)) return;
    needs.add(Effect::anisotropy, fmt::format("{} has an anisotropy of {:g}", name, strength));
    if (prepared.anisotropies[material].texture.texture != no_texture) {
        needs.add(Effect::textures, name + " has an anisotropy texture");
    }
}

void add_material(const Optics& optics, const std::string& name, Needs& needs) {
    const float radiance = std::max({optics.emission.x, optics.emission.y, optics.emission.z});
    if (optics.unlit != 0) needs.add(Effect::emission, name + " is unlit");
    if (radiance > 0 && optics.unlit == 0)
        needs.add(Effect::emission, fmt::format("{} emits a radiance of {:g}", name, radiance));
    const float mirror = std::max({optics.mirror.x, optics.mirror.y, optics.mirror.z});
    if (mirror > 0) needs.add(Effect::reflection, fmt::format("{} is a mirror with reflectance {:g}", name, mirror));
    if (!(optics.transmission > 0)) return;
    needs.add(Effect::refraction, fmt::format("{} has transmission {:g}", name, optics.transmission));
    const float absorption = std::max({optics.absorption.x, optics.absorption.y, optics.absorption.z});
    if (absorption > 0) {
        needs.add(Effect::absorption, fmt::format("{} absorbs up to {:g} per metre", name, absorption));
    }
}

}  // namespace

std::vector<EffectNeed> derive_effects(const Scene& scene, const PreparedScene& prepared) {
    const DefaultFpEnvironment guard;
    Needs needs;
    const std::vector<bool> used = used_materials(scene, prepared);
    add_motion(scene, prepared, needs);
#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, effect, is) \
    if (scene.authored) needs.add(effect, "the environment is " + in_words(*scene.authored));
#include "tandem/kernel/lights/lights.def"
    if (prepared.material_of.empty() && prepared.instances.empty()) return needs.take();  // nothing receives light
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (node.light && is_lit(*node.light)) add_light(*node.light, label("light", node.name, i), needs);
    }
    std::map<std::uint32_t, bool> coloured;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        if (!used[i]) continue;
        const std::string name = label("material", scene.materials[i].name, i);
        add_material(prepared.optics[i], name, needs);
        add_pictures(prepared.textures, i, name, coloured, needs);
#define TANDEM_MATERIAL_PART(Type, member, members, effect, is)                 \
    if (!prepared.members.empty() && prepared.members[i].is_there != 0) {       \
        needs.add(effect, name + " has " is + numbers_of(prepared.members[i])); \
    }
#include "tandem/kernel/bsdf/lobes.def"
#define TANDEM_PART_TEXTURE(part, effect, member, members, space, is)             \
    if (!prepared.members.empty() && prepared.members[i].texture != no_texture) { \
        needs.add(Effect::textures, name + " has a " is);                         \
    }
#include "tandem/kernel/bsdf/lobes.def"
        add_anisotropy(prepared, i, name, needs);
    }
    if (prepared.culled_node != PreparedScene::never) {
        const std::uint32_t node = prepared.culled_node;
        needs.add(Effect::cutouts,
                  label("node", scene.nodes[node].name, node) + " has single-sided faces that may be seen from behind");
    }
    add_surroundings(scene, prepared, needs);
    if (!prepared.area_lights.empty()) {
        const std::uint32_t first = prepared.material_of[prepared.area_lights.front().primitive];
        const std::string name = label("material", scene.materials[first].name, first);
        needs.add(Effect::area_lights, name + " is an area light");
        if (prepared.area_light_shadows) needs.add(Effect::shadows, name + " casts shadows");
    }
    if (prepared.media_overlap) {
        for (std::size_t i = 0; i < scene.materials.size(); ++i) {
            if (!used[i] || !(scene.materials[i].optics.transmission > 0)) continue;
            needs.add(Effect::nested_media, fmt::format("a solid of {} may touch or contain another one, or the camera",
                                                        label("material", scene.materials[i].name, i)));
        }
    }
    return needs.take();
}

EffectMask mask_of(const std::vector<EffectNeed>& needs) {
    EffectMask mask;
    for (const EffectNeed& need : needs) mask |= need.effect;
    return mask;
}

namespace {

/// Removes the texture, but keeps its alpha if that is a mask.
void remove_colours(Scene& scene, Material& material) {
    if (!material.diffuse_texture) return;
    if (material.alpha_mode == AlphaMode::opaque) return material.diffuse_texture.reset();
    Texture texture = scene.textures[material.diffuse_texture->texture];
    Image image = scene.images[texture.image];
    for (std::uint32_t& texel : image.texels) texel |= 0x00FFFFFFU;
    texture.image = static_cast<std::uint32_t>(scene.images.size());
    material.diffuse_texture->texture = static_cast<std::uint32_t>(scene.textures.size());
    scene.images.push_back(std::move(image));
    scene.textures.push_back(texture);
}

}  // namespace

Scene without_effects(Scene scene, EffectMask off) {
    for (Node& node : scene.nodes) {
        if (node.camera && off.has(Effect::motion_blur)) shutter_of(*node.camera) = {};
        if (node.camera && off.has(Effect::lens)) {
            if (auto* perspective = std::get_if<PerspectiveCamera>(&*node.camera)) perspective->lens = {};
        }
        if (!node.light) continue;
        if (off.has(Effect::shadows)) node.light->casts_shadows = false;
        if (off.has(Effect::inverse_square)) node.light->inverse_square = false;
        if (off.has(Effect::spot_lights) && node.light->kind == LightKind::spot) node.light->kind = LightKind::point;
        if (off.has(Effect::directional_lights) && node.light->kind == LightKind::directional) node.light.reset();
    }
    for (Material& material : scene.materials) {
        if (off.has(Effect::reflection)) material.optics.mirror = {0, 0, 0};
#define TANDEM_MATERIAL_PART(Type, name, names, needs, is) \
    if (off.has(needs)) material.name.reset();
#define TANDEM_PART_TEXTURE(part, needs, name, names, space, is) \
    if (off.has_any(needs | Effect::textures)) material.name.reset();
#include "tandem/kernel/bsdf/lobes.def"
        if (off.has(Effect::anisotropy)) {
            if (material.microfacets) material.microfacets->anisotropy = material.microfacets->rotation = 0;
            material.anisotropy_texture.reset();
        }
        if (off.has(Effect::refraction)) material.optics.transmission = 0;
        if (off.has(Effect::cutouts)) {
            material.alpha_mode = AlphaMode::opaque;
            if (material.sides == FaceSides::culled) material.sides = FaceSides::single_sided;
        }
        if (off.has(Effect::textures)) {
            remove_colours(scene, material);
            material.emissive_texture.reset();
            material.metallic_roughness_texture.reset();
            material.anisotropy_texture.reset();
        }
        if (off.has(Effect::normal_maps)) material.normal_texture.reset();
        if (off.has(Effect::emission)) {
            material.optics.emission = {0, 0, 0};
            material.unlit = false;
        }
        if (off.has(Effect::absorption)) material.optics.absorption = {0, 0, 0};
    }
    if (off.has(Effect::textures)) {
        for (Mesh& mesh : scene.meshes) mesh.colours.clear();
    }
#define TANDEM_ENVIRONMENT(Type, name, Authored, authored, needs, is) \
    if (off.has(needs)) scene.authored.reset();
#include "tandem/kernel/lights/lights.def"
    if (off.has(Effect::environment_light)) scene.environment.illuminates = 0;
    if (off.has(Effect::indirect)) scene.indirect_light = false;
    return scene;
}

RenderSettings without_effects(RenderSettings settings, EffectMask off) {
    if (off.has(Effect::nested_media)) settings.solids_are_disjoint = true;
    if (off.has(Effect::area_lights)) settings.area_lights = false;
    if (off.has(Effect::shadows)) settings.area_light_shadows = false;
    if (off.has(Effect::roulette)) settings.roulette = false;
    return settings;
}

}  // namespace tandem
