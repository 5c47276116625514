/// How the threads that follow paths wait for each other: a policy of the path loop.
#pragma once

#include "tandem/effects/effects.h"

namespace tandem {

/// The effects with which the code of a vertex exceeds the instruction caches of a GPU.
inline constexpr EffectMask synchronising_effects = bouncing_effects | Effect::area_lights;

/// No thread waits for another. A policy that waits has the same functions (cuda/block_threads.h).
struct IndependentThreads {
    /// Whether a thread takes part in the stages of a vertex even if it has nothing to do there.
    TANDEM_HD static constexpr bool wait_together() { return false; }
    /// Waits for all threads, before a stage.
    TANDEM_HD static void gather() {}
};

}  // namespace tandem
