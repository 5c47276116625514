/// How the threads or lanes that follow paths wait for each other: a policy that the path loop is given.
#pragma once

#include "tandem/effects/effects.h"

namespace tandem {

/// The effects that make the code of a vertex larger than the instruction caches of a GPU.
inline constexpr EffectMask synchronising_effects = bouncing_effects | Effect::area_lights;

/// No thread waits for another. A policy that waits has the same functions (cuda/block_threads.h).
struct IndependentThreads {
    /// Does a thread run a stage of a vertex with the others even if it has nothing to do there?
    TANDEM_HD static constexpr bool wait_together() { return false; }
    /// Waits for all, before a stage.
    TANDEM_HD static void gather() {}
};

}  // namespace tandem
