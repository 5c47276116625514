#include "cuda/first_hit_kernels.h"
#include "tandem/math/fast_math.h"

namespace tandem::cuda {

void launch_first_hits_fast(const DeviceSceneView& scene, const PixelJob& job, std::uint32_t height,
                            const FilmPlanes& planes, DeviceCounters* counters, cudaStream_t stream) {
    launch_first_hits<FastFloat>(scene, job, height, planes, counters, stream);
}

}  // namespace tandem::cuda
