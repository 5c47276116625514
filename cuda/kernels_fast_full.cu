#include "cuda/render_kernels.h"
#include "tandem/math/fast_math.h"

namespace tandem::cuda {

RenderKernel full_fast_kernel() { return compiled_render_kernel<1, FastFloat>(); }

}  // namespace tandem::cuda
