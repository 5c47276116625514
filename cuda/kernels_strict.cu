#include "cuda/tier_kernels.h"

namespace tandem::cuda {

const TierKernels& strict_kernels() {
    static const TierKernels kernels = tier_kernels<float>(full_strict_kernel());
    return kernels;
}

}  // namespace tandem::cuda
