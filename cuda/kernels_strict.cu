#include "cuda/trace_kernels.h"

namespace tandem::cuda {

void launch_trace_strict(const DeviceSceneView& scene, const DeviceRays& rays, cudaStream_t stream) {
    launch_trace<float>(scene, rays, stream);
}

}  // namespace tandem::cuda
