/// The parameters of cloth, besides its colour: the sheen of fibres.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// A layer of fibres over the rest of the material, as in KHR_materials_sheen (sheen_lobe.h).
struct Sheen {
    static constexpr bool is_opaque = true;

    Vec3f colour{0, 0, 0};       ///< RGB, each in [0, 1]; black is no sheen
    float roughness = 0;         ///< in [0, 1]: how much the fibres diverge from the normal
    std::uint32_t is_there = 1;  ///< 0: a material without a sheen, in an array of several materials

    template <class Self, class Visit>
    static constexpr void visit_numbers(Self& sheen, Visit visit) {
        visit("colour", sheen.colour, 0.0F, 1.0F);
        visit("roughness", sheen.roughness, 0.0F, 1.0F);
    }
};
static_assert(sizeof(Sheen) == 20, "no byte is undefined; scene_hash() reads all");

}  // namespace tandem
