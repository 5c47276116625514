#include "cuda/tier_kernels.h"

namespace tandem::cuda {

const TierKernels& strict_kernels() { return tier_kernels<float>; }

}  // namespace tandem::cuda
