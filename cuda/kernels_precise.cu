#include "cuda/trace_kernels.h"

namespace tandem::cuda {

void launch_trace_precise(const DeviceSceneView& scene, const DeviceRays& rays, cudaStream_t stream) {
    launch_trace<double>(scene, rays, stream);
}

}  // namespace tandem::cuda
