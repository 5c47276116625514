#include "cpu/kernel_variant.h"

namespace tandem {

const CpuKernels& cpu_kernels_v2() { return cpu_kernels<Sse4>; }

}  // namespace tandem
