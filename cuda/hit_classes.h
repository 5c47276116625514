/// Which hits of a block's paths are shaded together (cuda/staged_paths.h): those that need the same code. Only for
/// speed. Tested by tests/cuda/hit_classes_test.cpp.
#pragma once

#include <cstdint>

#include "tandem/kernel/shading_class.h"

namespace tandem::cuda {

/// In the shared memory of a block. `Lanes`: cuda/block_lanes.h.
struct HitClasses {
    static constexpr std::uint32_t count = 31;
    static constexpr std::uint32_t most_materials = 128;  ///< that are compared; later ones count as alike

    std::uint32_t words[most_materials];  ///< material_class()
    std::uint8_t first[most_materials];   ///< the first material with the same word
    std::uint8_t ranks[most_materials];   ///< of the word among the different ones: 0 for the one with most parts
    std::uint32_t rank_count;

    /// All threads of the block call it. Before a thread calls of(), all have to wait for each other.
    template <class Lanes>
    TANDEM_HD void compare_materials(const SceneView& scene) {
        const std::uint32_t materials = scene.material_count < most_materials ? scene.material_count : most_materials;
        const auto for_each_material = [&](auto visit) {
            for (std::uint32_t i = Lanes::thread(); i < materials; i += Lanes::threads()) visit(i);
            Lanes::wait_for_block();
        };
        for_each_material([&](std::uint32_t i) { words[i] = material_class(scene, i); });
        for_each_material([&](std::uint32_t i) {
            std::uint32_t same = 0;
            while (words[same] != words[i]) ++same;
            first[i] = static_cast<std::uint8_t>(same);
        });
        const auto count_firsts = [&](auto where) {
            std::uint32_t found = 0;
            for (std::uint32_t i = 0; i < materials; ++i) found += first[i] == i && where(i) ? 1U : 0U;
            return found;
        };
        for_each_material([&](std::uint32_t i) {
            const int parts = count_bits(words[i]);
            ranks[i] = static_cast<std::uint8_t>(count_firsts([&](std::uint32_t other) {
                const int others = count_bits(words[other]);
                return others > parts || (others == parts && other < first[i]);
            }));
        });
        if (Lanes::thread() == 0) rank_count = count_firsts([](std::uint32_t) { return true; });
    }

    /// The class of a hit: a number below `count`, the same for hits that need the same code. Others have the same one
    /// only if there are more classes than numbers. Hits of materials with many parts have low numbers, and of these,
    /// hits on faces: if they are shaded first, no warp begins their long code while others already wait for the end of
    /// the stage. `kinds`: of the tracer.
    template <std::uint32_t kinds>
    [[nodiscard]] TANDEM_HD std::uint32_t of(const SceneView& scene, std::uint32_t primitive) const {
        const std::uint32_t material = material_of<kinds>(scene, primitive);
        const std::uint32_t rank = material < most_materials ? ranks[material] : rank_count;
        return ((rank + 1) * kind_count<kinds>() - 1 - kind_number<kinds>(scene, primitive)) % count;
    }
};

}  // namespace tandem::cuda
