#include "tandem/scene/corner_slots.h"

#include <utility>

namespace tandem {

namespace {

std::vector<std::uint32_t> once_each(std::vector<std::uint32_t> sets) {
    std::sort(sets.begin(), sets.end());
    sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
    return sets;
}

}  // namespace

std::vector<std::uint32_t> texcoord_sets(const Material& material) {
    std::vector<std::uint32_t> sets;
    for (const auto* reference : {&material.diffuse_texture, &material.normal_texture, &material.emissive_texture,
                                  &material.metallic_roughness_texture, &material.anisotropy_texture}) {
        if (*reference) sets.push_back((*reference)->texcoord);
    }
#define TANDEM_PART_TEXTURE(part, needs, name, names, space, is) \
    if (material.name) sets.push_back(material.name->texcoord);
#include "tandem/kernel/bsdf/lobes.def"
    return once_each(std::move(sets));
}

std::uint32_t tangent_set(const Material& material) {
    if (material.normal_texture) return material.normal_texture->texcoord;
    return material.anisotropy_texture ? material.anisotropy_texture->texcoord : 0;
}

std::vector<std::uint32_t> corner_sets(const Material& material) {
    std::vector<std::uint32_t> sets = texcoord_sets(material);
    if (is_anisotropic(material)) sets.push_back(tangent_set(material));
    return once_each(std::move(sets));
}

std::vector<CornerSlots> corner_slots(const Scene& scene) {
    std::vector<CornerSlots> slots;
    for (const Material& material : scene.materials) slots.push_back({corner_sets(material), false});
    for (const Node& node : scene.nodes) {
        for (const Geometry& geometry : node.geometry) {
            const auto* shape = std::get_if<MeshShape>(&geometry.shape);
            if (shape != nullptr && !scene.meshes[shape->mesh].colours.empty()) {
                slots[geometry.material].has_colours = true;
            }
        }
    }
    return slots;
}

}  // namespace tandem
