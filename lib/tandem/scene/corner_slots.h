/// The values at the corners of faces, by material: only those that its textures and the colours of its meshes need.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tandem/scene/scene.h"

namespace tandem {

/// The slots of a material's faces (FaceAttributes): one for each set of texture coordinates that it uses
/// (corner_sets()), in order, then two for colours, if any mesh under the material has them.
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

/// The set whose u grows along the tangent of an anisotropic material: that of its normal texture, else of its
/// anisotropy texture, else the first. A mesh need not have it.
[[nodiscard]] std::uint32_t tangent_set(const Material& material);

/// All sets that a material uses, ascending: those of its textures, and of its tangent if it is anisotropic.
[[nodiscard]] std::vector<std::uint32_t> corner_sets(const Material& material);

/// Of all materials.
[[nodiscard]] std::vector<CornerSlots> corner_slots(const Scene& scene);

}  // namespace tandem
