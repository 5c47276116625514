// The kernel that fills the planes of first hits in scenes of instances, for one tier (TANDEM_FIRST_HITS_TIER). The
// tier fast has that of strict.
#include "cuda/first_hit_kernels.h"
#include "cuda/tier_real.h"

namespace tandem::cuda {

#define TANDEM_FIRST_HITS_JOINED(tier) launch_first_hits_instanced_##tier
#define TANDEM_FIRST_HITS_NAME(tier) TANDEM_FIRST_HITS_JOINED(tier)

void TANDEM_FIRST_HITS_NAME(TANDEM_FIRST_HITS_TIER)(const DeviceSceneView& scene, const PixelJob& job,
                                                    std::uint32_t height, const FilmPlanes& planes,
                                                    DeviceCounters* counters, cudaStream_t stream) {
    using Real = tier_real::TANDEM_FIRST_HITS_TIER;
    launch_first_hits<Real>(instanced_tracer(scene, counters), job, height, planes, stream);
}

}  // namespace tandem::cuda
