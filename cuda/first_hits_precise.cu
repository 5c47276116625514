#include "cuda/first_hit_kernels.h"

namespace tandem::cuda {

void launch_first_hits_precise(const DeviceSceneView& scene, const PixelJob& job, std::uint32_t height,
                               const FilmPlanes& planes, DeviceCounters* counters, cudaStream_t stream) {
    launch_first_hits<double>(scene, job, height, planes, counters, stream);
}

}  // namespace tandem::cuda
