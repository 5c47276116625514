#include "tandem/compile/cutout_kinds.h"

#include <algorithm>

namespace tandem {

std::uint32_t kinds_cut_out_by_alpha(const SceneView& scene) {
    const auto is_cut_out = [&](std::uint32_t material) { return has_alpha_mask(scene, material); };
    std::uint32_t kinds = 0;
    const std::uint32_t* first = scene.material_of;
#define TANDEM_PRIMITIVE(Type, name, names)                                                        \
    if (std::any_of(first, first + scene.name##_count, is_cut_out)) kinds |= PrimitiveKinds::name; \
    first += scene.name##_count;
#include "tandem/kernel/view/primitives.def"
#undef TANDEM_PRIMITIVE
    return kinds;
}

}  // namespace tandem
