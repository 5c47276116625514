/// Keeping the threads of a GPU's block together.
#pragma once

#include "tandem/effects/effects.h"

namespace tandem {

/// Where paths go on, the threads of a block wait here for each other; elsewhere nothing happens. The code of a vertex
/// is longer than the caches for instructions next to the cores: warps that come to it together fetch it once, others
/// wait for it most of their time (docs/performance.md). All threads of a block have to come here, whether their paths
/// are alive or not.
template <class Effects>
TANDEM_HD void gather_block() {
#if TANDEM_ON_DEVICE
    if (has_bounces<Effects>()) __syncthreads();
#endif
}

}  // namespace tandem
