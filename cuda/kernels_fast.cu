#include "cuda/tier_kernels.h"
#include "tandem/math/fast_math.h"

namespace tandem::cuda {

const TierKernels& fast_kernels() {
    static const TierKernels kernels = tier_kernels<FastFloat>(full_fast_kernel());
    return kernels;
}

}  // namespace tandem::cuda
