/// Keeping the threads of a GPU's block together.
#pragma once

#include "tandem/effects/effects.h"

namespace tandem {

/// The effects that make the code of a vertex larger than the instruction caches.
inline constexpr EffectMask synchronising_effects = bouncing_effects | Effect::area_lights;

/// Do the threads of a block synchronise? Then a thread runs a stage of a vertex with the others even if it has nothing
/// to do there.
template <class Effects>
TANDEM_HD bool keeps_together() {
    return TANDEM_ON_DEVICE && Effects::has_any(synchronising_effects);
}

/// A barrier for the threads of a block, in kernels with such effects. Warps that run a stage together fetch its code
/// once; otherwise they wait for instructions most of the time (docs/performance.md). All threads of a block must call
/// this, whether their paths are alive or not.
template <class Effects>
TANDEM_HD void gather_block() {
#if TANDEM_ON_DEVICE
    if (keeps_together<Effects>()) __syncthreads();
#endif
}

}  // namespace tandem
