/// The values at the corners of faces, by material: only those that its textures and the colours of its meshes need.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tandem/scene/scene.h"

namespace tandem {

/// The slots of a material's faces (FaceAttributes): one for each set of texture coordinates that it uses, in order,
/// then two for colours, if any mesh under the material has them.
struct CornerSlots {
    std::vector<std::uint32_t> texcoords;  ///< numbers of the sets, ascending
    bool has_colours = false;

    [[nodiscard]] std::size_t count() const { return texcoords.size() + (has_colours ? 2 : 0); }
    [[nodiscard]] bool empty() const { return count() == 0; }
    [[nodiscard]] std::uint32_t slot_of(std::uint32_t set) const {
        const auto at = std::lower_bound(texcoords.begin(), texcoords.end(), set);
        return static_cast<std::uint32_t>(at - texcoords.begin());
    }
    [[nodiscard]] std::uint32_t colour_slot() const { return static_cast<std::uint32_t>(texcoords.size()); }
};

/// The sets of texture coordinates that a material's textures use, ascending.
[[nodiscard]] std::vector<std::uint32_t> texcoord_sets(const Material& material);

/// The slots of all materials.
[[nodiscard]] std::vector<CornerSlots> corner_slots(const Scene& scene);

}  // namespace tandem
