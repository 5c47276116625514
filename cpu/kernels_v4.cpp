#include "cpu/kernel_variant.h"

namespace tandem {

const TierKernels& exact_kernels_v4(Tier tier) {
    return tier == Tier::precise ? tier_kernels<Precise<Avx512>> : tier_kernels<Strict<Avx512>>;
}

}  // namespace tandem
