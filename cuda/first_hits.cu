// The kernels that fill the planes of first hits, for one tier (TANDEM_FIRST_HITS_TIER): cuda/CMakeLists.txt compiles
// this file for each. Scenes of instances have kernels of their own (first_hits_instanced.cu).
#include "cuda/first_hit_kernels.h"
#include "cuda/tier_real.h"

namespace tandem::cuda {

#define TANDEM_FIRST_HITS_JOINED(tier) launch_first_hits_##tier
#define TANDEM_FIRST_HITS_NAME(tier) TANDEM_FIRST_HITS_JOINED(tier)

void TANDEM_FIRST_HITS_NAME(TANDEM_FIRST_HITS_TIER)(const DeviceSceneView& scene, const PixelJob& job,
                                                    std::uint32_t height, const FilmPlanes& planes,
                                                    DeviceCounters* counters, cudaStream_t stream) {
    using Real = tier_real::TANDEM_FIRST_HITS_TIER;
    with_tracer(scene, counters,
                [&](const auto& tracer) { launch_first_hits<Real>(tracer, job, height, planes, stream); });
}

}  // namespace tandem::cuda
