/// Which paths of a block wait for which stage (cuda/staged_paths.h). Tested by tests/cuda/stage_lists_test.cpp.
#pragma once

#include <cstdint>

#include "cuda/hit_classes.h"
#include "tandem/math/host_device.h"

namespace tandem::cuda {

/// Lists of up to `most` paths, in the shared memory of a block. Those of the next turn are filled while those of this
/// turn are read.
template <std::uint32_t most>
struct StageLists {
    static constexpr std::uint32_t classes = HitClasses::count + 1;  ///< the last one is that of no hit
    static constexpr std::uint16_t path_ends = 0x8000;  ///< the bit of shadow rays whose path has no other ray

    /// The paths that wait for rays.
    struct Rays {
        std::uint16_t paths[most];    ///< new paths from the front, others from the back
        std::uint16_t shadows[most];  ///< shadow rays
        std::uint32_t new_count, open_count, shadow_count;
    };
    Rays rays[2];

    std::uint16_t places[most];  ///< of the hit of each path among those of its class, and the class; or no_hit
    std::uint16_t hits[most];    ///< the paths with hits, by class
    std::uint32_t class_count[2][classes];
    std::uint32_t class_start[classes + 1];  ///< in `hits`
    std::uint32_t class_warps[classes + 1];  ///< warps that the classes before need, each with hits of one class
    std::uint32_t rays_taken, hits_taken;    ///< by the warps
    std::uint32_t traced;                    ///< rays of this turn, if they are counted one by one

    HitClasses hit_classes;

    static constexpr std::uint32_t no_hit = 0xFFFF;
    TANDEM_HD_INLINE static constexpr std::uint32_t place_word(std::uint32_t place, std::uint32_t of_class) {
        return place * classes + of_class;
    }
    static_assert((most - 1) * classes + classes - 2 < no_hit && most <= path_ends);
};

/// How the threads of a block use the lists. `Lanes`: cuda/block_lanes.h.
template <class Lanes>
struct ListThreads {
    TANDEM_HD static std::uint32_t warps_for(std::uint32_t count) { return (count + Lanes::count - 1) / Lanes::count; }

    /// Those of `count` paths beyond whole warps, if they are less than half a warp: a warp takes as long for a few.
    TANDEM_HD static constexpr std::uint32_t too_few_of(std::uint32_t count) {
        const std::uint32_t rest = count % Lanes::count;
        return rest < Lanes::count / 2 ? rest : 0;
    }

    /// The next piece of work of a stage, for the whole warp.
    TANDEM_HD static std::uint32_t take(std::uint32_t& taken) {
        std::uint32_t number = 0;
        if (Lanes::lane() == 0) number = Lanes::add(taken, 1U);
        return Lanes::of_lane(all, number, 0);
    }
    /// The place in a list that grows by the lanes of `group`, for each of them. Lanes of several groups may call it
    /// together; `together` has all of them.
    TANDEM_HD static std::uint32_t append(std::uint32_t& count, std::uint32_t group, std::uint32_t together) {
        const std::uint32_t leader = Lanes::first(group);
        std::uint32_t before = 0;
        if (Lanes::lane() == leader) before = Lanes::add(count, Lanes::size(group));
        return Lanes::of_lane(together, before, leader) + Lanes::place_in(group);
    }

    static constexpr std::uint32_t all = Lanes::count == 32 ? 0xFFFFFFFFU : (1U << Lanes::count) - 1U;
};

}  // namespace tandem::cuda
