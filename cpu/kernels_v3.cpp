#include "cpu/kernel_variant.h"

namespace tandem {

const CpuKernels& cpu_kernels_v3() { return cpu_kernels<Avx2>; }

}  // namespace tandem
