// The kernels that fill the planes of first hits, for one tier (TANDEM_FIRST_HITS_TIER), as the function
// TANDEM_FIRST_HITS_NAME. TANDEM_FIRST_HITS_TRACERS: with_tracer, or with_instanced_tracer for scenes of instances.
// cuda/CMakeLists.txt compiles this file for each tier and each of these.
#include "cuda/first_hit_kernels.h"
#include "cuda/tier_real.h"

namespace tandem::cuda {

void TANDEM_FIRST_HITS_NAME(const DeviceSceneView& scene, const PixelJob& job, std::uint32_t height,
                            const FilmPlanes& planes, DeviceCounters* counters, cudaStream_t stream) {
    TANDEM_FIRST_HITS_TRACERS(scene, counters, [&](const auto& tracer) {
        launch_first_hits<tier_real::TANDEM_FIRST_HITS_TIER>(tracer, job, height, planes, stream);
    });
}

}  // namespace tandem::cuda
