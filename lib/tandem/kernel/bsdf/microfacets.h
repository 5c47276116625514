/// What a material of microfacets says beside its colour: glTF's metallic-roughness model.
#pragma once

#include <cstdint>

namespace tandem {

/// Of such a material Phong's diffuse reflectance is the base colour, Phong's highlight is replaced by a reflection
/// from GGX microfacets, and Optics::ior is the index of its dielectric part (metallic_roughness.h).
struct Microfacets {
    float metallic = 1;          ///< share of metal, in [0, 1]; the rest is a dielectric over a diffuse base
    float roughness = 1;         ///< in [0, 1]; alpha of GGX is its square
    std::uint32_t is_there = 1;  ///< 0: a material without microfacets, in an array of several materials
    float anisotropy = 0;        ///< in [0, 1]: how much rougher in one direction, as KHR_materials_anisotropy has it
    float rotation = 0;          ///< of that direction: radians, counter-clockwise from where u grows
};
static_assert(sizeof(Microfacets) == 20, "no byte is undefined; scene_hash() reads all");

}  // namespace tandem
