#include "cpu/kernel_variant.h"

namespace tandem {

const TierKernels& exact_kernels_v3(Tier tier) {
    return tier == Tier::precise ? tier_kernels<Precise<Avx2>> : tier_kernels<Strict<Avx2>>;
}

}  // namespace tandem
