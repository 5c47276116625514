/// Keeping the threads of a GPU's block together.
#pragma once

#include "tandem/effects/effects.h"

namespace tandem {

/// What makes the code of a vertex longer than the caches for instructions next to the cores.
inline constexpr EffectMask gathering_effects = bouncing_effects | Effect::area_lights;

/// Are they kept together? Then a thread goes through a part of the code with the others though it has nothing to do
/// there.
template <class Effects>
TANDEM_HD bool keeps_together() {
    return TANDEM_ON_DEVICE && Effects::has_any(gathering_effects);
}

/// In kernels with such effects the threads of a block wait here for each other. Warps that come to a part of the code
/// together fetch it once, others wait for it most of their time (docs/performance.md). All threads of a block have to
/// come here, their paths alive or not.
template <class Effects>
TANDEM_HD void gather_block() {
#if TANDEM_ON_DEVICE
    if (keeps_together<Effects>()) __syncthreads();
#endif
}

}  // namespace tandem
