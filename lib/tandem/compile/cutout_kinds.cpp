#include "tandem/compile/cutout_kinds.h"

#include <algorithm>

namespace tandem {

std::uint32_t kinds_cut_out_by_alpha(const PreparedScene& scene) {
    const SceneView all = view(scene);
    const auto is_cut_out = [&](std::uint32_t material) { return has_alpha_mask(all, material); };
    std::uint32_t kinds = 0;
    const std::uint32_t* first = all.material_of;
#define TANDEM_PRIMITIVE(Type, name, names)                                                      \
    if (std::any_of(first, first + all.name##_count, is_cut_out)) kinds |= PrimitiveKinds::name; \
    first += all.name##_count;
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
    const std::vector<InstancedMesh>& meshes = scene.instances.meshes;
    if (std::any_of(meshes.begin(), meshes.end(),
                    [&](const InstancedMesh& mesh) { return is_cut_out(mesh.material); })) {
        kinds |= PrimitiveKinds::triangle;
    }
    return kinds;
}

}  // namespace tandem
