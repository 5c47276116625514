/// The parameters of a material with microfacets, besides its colour: glTF's metallic-roughness model.
#pragma once

#include <cstdint>

namespace tandem {

/// As in glTF 2.0. Of such a material Phong's diffuse reflectance is the base colour, Phong's highlight is replaced by
/// a reflection from GGX microfacets, and Optics::ior is the index of its dielectric part (metallic_roughness.h).
struct Microfacets {
    static constexpr bool is_opaque = true;

    float metallic = 1;          ///< share of metal, in [0, 1]; the rest is a dielectric over a diffuse base
    float roughness = 1;         ///< in [0, 1]; alpha of GGX is its square
    std::uint32_t is_there = 1;  ///< 0: a material without microfacets, in an array of several materials
    float anisotropy = 0;        ///< in [0, 1]: how much rougher in one direction, as KHR_materials_anisotropy has it
    float rotation = 0;          ///< of that direction: radians, counter-clockwise from where u grows

    template <class Self, class Visit>
    static constexpr void visit_numbers(Self& facets, Visit visit) {
        visit("metallic", facets.metallic, 0.0F, 1.0F);
        visit("roughness", facets.roughness, 0.0F, 1.0F);
        visit("anisotropy", facets.anisotropy, 0.0F, 1.0F);
        visit("rotation", facets.rotation, -1e18F, 1e18F);
    }
};
static_assert(sizeof(Microfacets) == 20, "no byte is undefined; scene_hash() reads all");

}  // namespace tandem
