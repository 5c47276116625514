#include "cpu/kernel_variant.h"
#include "tandem/math/fast_math.h"

namespace tandem {

const TierKernels& fast_kernels_v2() { return tier_kernels<TierReals<FastFloat, Lanes<float, Fast<Sse4>>>>; }

}  // namespace tandem
