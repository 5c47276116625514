/// Keeping the threads of a block together.
#pragma once

#include "tandem/kernel/threads.h"

namespace tandem::cuda {

/// In kernels with effects that synchronise, the threads of a block do so before each stage of a vertex. Warps that run
/// a stage together fetch its code once; otherwise they wait for instructions most of the time
/// (docs/performance/paths.md). All threads of a block must call gather(), whether their paths are alive or not.
template <class Effects>
struct BlockThreads {
    TANDEM_HD static bool wait_together() { return Effects::has_any(synchronising_effects); }
    TANDEM_HD static void gather() {
#if TANDEM_ON_DEVICE
        if (wait_together()) __syncthreads();
#endif
    }
};

}  // namespace tandem::cuda
