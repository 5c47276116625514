#include "tandem/scene/corner_slots.h"

namespace tandem {

std::vector<std::uint32_t> texcoord_sets(const Material& material) {
    std::vector<std::uint32_t> sets;
    for (const auto* reference : {&material.diffuse_texture, &material.normal_texture, &material.emissive_texture,
                                  &material.metallic_roughness_texture}) {
        if (*reference) sets.push_back((*reference)->texcoord);
    }
    std::sort(sets.begin(), sets.end());
    sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
    return sets;
}

std::vector<CornerSlots> corner_slots(const Scene& scene) {
    std::vector<CornerSlots> slots;
    for (const Material& material : scene.materials) slots.push_back({texcoord_sets(material), false});
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
