#include "cuda/tier_kernels.h"

namespace tandem::cuda {

const TierKernels& precise_kernels() { return tier_kernels<double>; }

}  // namespace tandem::cuda
