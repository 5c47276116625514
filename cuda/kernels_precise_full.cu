#include "cuda/render_kernels.h"

namespace tandem::cuda {

RenderKernel full_precise_kernel() { return compiled_render_kernel<1, double>(); }

}  // namespace tandem::cuda
