#include "cuda/render_kernels.h"

namespace tandem::cuda {

RenderKernel full_strict_kernel() { return compiled_render_kernel<1, float>(); }

}  // namespace tandem::cuda
