#include "cuda/tier_kernels.h"
#include "tandem/math/fast_math.h"

namespace tandem::cuda {

const TierKernels& fast_kernels() { return tier_kernels<FastFloat>; }

}  // namespace tandem::cuda
