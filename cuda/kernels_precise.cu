#include "cuda/tier_kernels.h"

namespace tandem::cuda {

const TierKernels& precise_kernels() {
    static const TierKernels kernels = tier_kernels<double>(full_precise_kernel());
    return kernels;
}

}  // namespace tandem::cuda
