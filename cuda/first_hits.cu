// The kernels that fill the planes of first hits, for one tier (TANDEM_FIRST_HITS_TIER). cuda/CMakeLists.txt compiles
// this file for each tier.
#include "cuda/first_hit_kernels.h"
#include "cuda/tier_real.h"

namespace tandem::cuda {

#define TANDEM_FIRST_HITS_JOINED(tier) launch_first_hits_##tier
#define TANDEM_FIRST_HITS_NAME(tier) TANDEM_FIRST_HITS_JOINED(tier)

void TANDEM_FIRST_HITS_NAME(TANDEM_FIRST_HITS_TIER)(const DeviceSceneView& scene, const PixelJob& job,
                                                    std::uint32_t height, const FilmPlanes& planes,
                                                    DeviceCounters* counters, cudaStream_t stream) {
    fill_first_hits<tier_real::TANDEM_FIRST_HITS_TIER>(scene, job, height, planes, counters, stream);
}

}  // namespace tandem::cuda
