#include "tandem/effects/derive.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace tandem {

namespace {

/// "material 'glass'", or by its number if it has no name.
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

void add_light(const LightSource& light, const std::string& name, Needs& needs) {
    if (light.casts_shadows) needs.add(Effect::shadows, name + " casts shadows");
    if (light.kind == LightKind::spot) needs.add(Effect::spot_lights, name + " is a spot light");
    if (light.kind == LightKind::directional) {
        needs.add(Effect::directional_lights, name + " shines from one direction");
    } else if (light.inverse_square) {
        needs.add(Effect::inverse_square, name + " falls off with distance");
    }
}

void add_material(const Optics& optics, const std::string& name, Needs& needs) {
    const float mirror = std::max({optics.mirror.x, optics.mirror.y, optics.mirror.z});
    if (mirror > 0) needs.add(Effect::reflection, fmt::format("{} is a mirror of reflectance {:g}", name, mirror));
    if (!(optics.transmission > 0)) return;
    needs.add(Effect::refraction, fmt::format("{} has transmission {:g}", name, optics.transmission));
    const float absorption = std::max({optics.absorption.x, optics.absorption.y, optics.absorption.z});
    if (absorption > 0) {
        needs.add(Effect::absorption, fmt::format("{} absorbs up to {:g} per metre", name, absorption));
    }
}

}  // namespace

std::vector<EffectNeed> derive_effects(const Scene& scene, const PreparedScene& prepared) {
    Needs needs;
    std::vector<bool> used(scene.materials.size(), false);
    for (const std::uint32_t material : prepared.material_of) used[material] = true;
    if (prepared.material_of.empty()) return {};  // nothing receives light
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (node.light && is_lit(*node.light)) add_light(*node.light, label("light", node.name, i), needs);
    }
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        if (used[i]) add_material(scene.materials[i].optics, label("material", scene.materials[i].name, i), needs);
    }
    if (prepared.media_overlap) {
        for (std::size_t i = 0; i < scene.materials.size(); ++i) {
            if (!used[i] || !(scene.materials[i].optics.transmission > 0)) continue;
            needs.add(Effect::nested_media, fmt::format("a body of {} may touch or hold another, or the camera",
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

Scene without_effects(Scene scene, EffectMask off) {
    for (Node& node : scene.nodes) {
        if (!node.light) continue;
        if (off.has(Effect::shadows)) node.light->casts_shadows = false;
        if (off.has(Effect::inverse_square)) node.light->inverse_square = false;
        if (off.has(Effect::spot_lights) && node.light->kind == LightKind::spot) node.light->kind = LightKind::point;
        if (off.has(Effect::directional_lights) && node.light->kind == LightKind::directional) node.light.reset();
    }
    for (Material& material : scene.materials) {
        if (off.has(Effect::reflection)) material.optics.mirror = {0, 0, 0};
        if (off.has(Effect::refraction)) material.optics.transmission = 0;
        if (off.has(Effect::absorption)) material.optics.absorption = {0, 0, 0};
    }
    if (off.has(Effect::nested_media)) scene.bodies_lie_apart = true;
    return scene;
}

}  // namespace tandem
