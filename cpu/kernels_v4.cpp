#include "cpu/kernel_variant.h"

namespace tandem {

const CpuKernels& cpu_kernels_v4() { return cpu_kernels<Avx512>; }

}  // namespace tandem
