#include "cuda/trace_kernels.h"
#include "tandem/math/fast_math.h"

namespace tandem::cuda {

void launch_trace_fast(const DeviceSceneView& scene, const DeviceRays& rays, cudaStream_t stream) {
    launch_trace<FastFloat>(scene, rays, stream);
}

}  // namespace tandem::cuda
