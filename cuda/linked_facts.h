/// The facts that a render kernel is specialised for (cuda/scene_kernels.h): one struct, made on the host from the
/// scene and the job; a constant for the linked kernel.
#pragma once

#include <cstdint>

namespace tandem::cuda {

/// A plain struct of 32-bit integers.
struct LinkedFacts {
    static constexpr std::uint32_t any = ~0U;  ///< for `lights`: not a constant

    std::uint32_t effects = 0;                                  ///< EffectMask::bits()
    std::uint32_t kinds = 0;                                    ///< PrimitiveKinds that the scene has
    std::uint32_t light_kinds = 0;                              ///< PrimitiveKinds of the area lights
    std::uint32_t cutout_kinds = 0;                             ///< PrimitiveKinds with alpha masks or culled faces
    std::uint32_t several_slots = 0;                            ///< SceneView::several_slots
    std::uint32_t lights = 0;                                   ///< punctual lights
    std::uint32_t reflection = 0, refraction = 0, diffuse = 0;  ///< PathLimits

    friend auto operator<=>(const LinkedFacts&, const LinkedFacts&) = default;
};

}  // namespace tandem::cuda
