/// The facts that a render kernel is linked for (cuda/scene_kernels.h): one struct, made on the host from the scene and
/// the job, or when Tandem is built (compiled_facts.cu). A constant to the kernel once it is linked. This header
/// includes no header that reads a fact, because linked_kernel.cu defines only afterwards where the facts are.
#pragma once

#include <cstdint>

#include "tandem/effects/effects.h"

namespace tandem::cuda {

/// A plain struct of 32-bit integers.
struct LinkedFacts {
    static constexpr std::uint32_t any = ~0U;  ///< of lights and limits: not a constant

    std::uint32_t effects = 0;                                  ///< EffectMask::bits()
    std::uint32_t kinds = 0;                                    ///< PrimitiveKinds that the scene has
    std::uint32_t light_kinds = 0;                              ///< PrimitiveKinds of the area lights
    std::uint32_t area_lights = 0;                              ///< KnownAreaLights
    std::uint32_t cutout_kinds = 0;                             ///< kinds with masks or culled faces; 0 without cutouts
    std::uint32_t masked_kinds = 0;                             ///< kinds with alpha masks, likewise
    std::uint32_t several_slots = 0;                            ///< SceneView::several_slots
    std::uint32_t lights = 0;                                   ///< punctual lights
    std::uint32_t reflection = 0, refraction = 0, diffuse = 0;  ///< PathLimits
    std::uint32_t sampler = 0;                                  ///< Sampler, or `any`
    std::uint32_t filter = 0;                                   ///< PixelFilter, or `any`
    std::uint32_t in_stages = 0;                                ///< whether paths are followed in stages

    friend auto operator<=>(const LinkedFacts&, const LinkedFacts&) = default;
};

/// The facts that hold for all scenes with no other effects and no other PrimitiveKinds.
constexpr LinkedFacts facts_of_any_scene(EffectMask effects, std::uint32_t kinds) {
    constexpr std::uint32_t any = LinkedFacts::any;
    const std::uint32_t cutout_kinds = effects.has(Effect::cutouts) ? kinds : 0;
    return {.effects = effects.bits(),
            .kinds = kinds,
            .light_kinds = kinds,
            .cutout_kinds = cutout_kinds,
            .masked_kinds = cutout_kinds,
            .several_slots = 1,
            .lights = any,
            .reflection = any,
            .refraction = any,
            .diffuse = any,
            .sampler = any,
            .filter = any};
}

}  // namespace tandem::cuda
