#include "cpu/kernel_variant.h"

namespace tandem {

const TierKernels& exact_kernels_v2(Tier tier) {
    return tier == Tier::precise ? tier_kernels<Precise<Sse4>> : tier_kernels<Strict<Sse4>>;
}

}  // namespace tandem
