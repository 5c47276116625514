// Everything of the kernel side that computes, for ptx.py to look at: the exact functions and one pixel.
#include "tandem/geometry/intersect.h"
#include "tandem/integrator/pixel.h"
#include "tandem/math/exact_math.h"

namespace tandem {

__global__ void exact_functions(const float* x, const float* y, float* out) {
    const unsigned i = threadIdx.x;
    out[0 * blockDim.x + i] = exact_sin(x[i]);
    out[1 * blockDim.x + i] = exact_cos(x[i]);
    out[2 * blockDim.x + i] = exact_exp(x[i]);
    out[3 * blockDim.x + i] = exact_log(x[i]);
    out[4 * blockDim.x + i] = exact_pow(x[i], y[i]);
}

__global__ void one_pixel(SceneView scene, PixelJob job, double* out) {
    const auto pixel = render_pixel<float>(LoopTracer{scene}, scene, job, blockIdx.x, threadIdx.x, true);
    out[0] = pixel.sum.x;
    out[1] = pixel.sum.y;
    out[2] = pixel.sum.z;
}

}  // namespace tandem
