/// The order in which a block shades the hits of its paths (cuda/staged_paths.h): by class, so that a warp has hits of
/// one class. Tested by tests/cuda/sort_hits_test.cpp.
#pragma once

#include <cstdint>

#include "cuda/stage_lists.h"

namespace tandem::cuda {

/// Hits of one class.
struct ClassHits {
    std::uint32_t start;   ///< in StageLists::hits
    std::uint32_t shaded;  ///< in this turn; the others wait
};

/// Orders the hits of `count` paths by their classes, for the turn with the number `turn`. If there is work for all
/// warps, the last hits of a class wait for the next turn where they are too few. All threads of the block call it,
/// between two waits for each other.
template <class Lanes, class Lists>
TANDEM_HD void sort_hits(Lists& lists, std::uint32_t turn, std::uint32_t count) {
    using Threads = ListThreads<Lanes>;
    const std::uint32_t* counts = lists.class_count[turn];
    std::uint32_t whole_warps = 0;
    for (std::uint32_t i = 0; i < Lists::classes; ++i) whole_warps += counts[i] / Lanes::count;
    const bool may_wait = whole_warps >= Lanes::threads() / Lanes::count;
    const auto waiting_of = [&](std::uint32_t number) { return may_wait ? Threads::too_few_of(counts[number]) : 0U; };

    // every warp computes the starts for itself, so that the block need not wait for one of them
    std::uint32_t shaded_before = 0, warps_before = 0;
    ClassHits own = {0, 0};  // of the last class that this lane computes
    for (std::uint32_t first = 0; first < Lists::classes; first += Lanes::count) {
        const std::uint32_t number = first + Lanes::lane();
        const std::uint32_t waiting = waiting_of(number);
        own.shaded = counts[number] - waiting;
        const std::uint32_t shaded = Lanes::sum_up_to(own.shaded);
        const std::uint32_t warps = Lanes::sum_up_to(Threads::warps_for(own.shaded));
        own.start = shaded_before + shaded - own.shaded;
        if (Lanes::thread() < Lanes::count) {
            lists.class_start[number] = own.start;
            lists.class_warps[number] = warps_before + warps - Threads::warps_for(own.shaded);
            lists.class_count[turn ^ 1][number] = waiting;
        }
        shaded_before += Lanes::of_lane(Threads::all, shaded, Lanes::count - 1);
        warps_before += Lanes::of_lane(Threads::all, warps, Lanes::count - 1);
    }
    if (Lanes::thread() == 0) {
        lists.class_start[Lists::classes] = shaded_before;
        lists.class_warps[Lists::classes] = warps_before;
        lists.hits_taken = 0;
    }
    const auto hits_of = [&](std::uint32_t of_class) -> ClassHits {
        if constexpr (Lanes::count == Lists::classes) {
            return {Lanes::of_lane(Threads::all, own.start, of_class),
                    Lanes::of_lane(Threads::all, own.shaded, of_class)};
        } else {
            std::uint32_t before = 0;
            for (std::uint32_t i = 0; i < of_class; ++i) before += counts[i] - waiting_of(i);
            return {before, counts[of_class] - waiting_of(of_class)};
        }
    };
    for (std::uint32_t first = Lanes::thread() - Lanes::lane(); first < count; first += Lanes::threads()) {
        const std::uint32_t path = first + Lanes::lane();
        const std::uint32_t word = path < count ? lists.places[path] : Lists::no_hit;
        const std::uint32_t of_class = word % Lists::classes;
        const ClassHits hits = hits_of(of_class);
        if (word == Lists::no_hit) continue;
        const std::uint32_t place = word / Lists::classes;
        if (place < hits.shaded) lists.hits[hits.start + place] = static_cast<std::uint16_t>(path);
        lists.places[path] = static_cast<std::uint16_t>(
            place < hits.shaded ? Lists::no_hit : Lists::place_word(place - hits.shaded, of_class));
    }
}

}  // namespace tandem::cuda
