// The kernels that fill the planes of first hits, for one tier (TANDEM_FIRST_HITS_TIER); with
// TANDEM_FIRST_HITS_INSTANCED also those for scenes of instances. cuda/CMakeLists.txt compiles this file for each tier.
#include "cuda/first_hit_kernels.h"
#include "cuda/tier_real.h"

namespace tandem::cuda {

#define TANDEM_FIRST_HITS_OF(name, with, tier)                                                                      \
    void name##_##tier(const DeviceSceneView& scene, const PixelJob& job, std::uint32_t height,                     \
                       const FilmPlanes& planes, DeviceCounters* counters, cudaStream_t stream) {                   \
        with(scene, counters,                                                                                       \
             [&](const auto& tracer) { launch_first_hits<tier_real::tier>(tracer, job, height, planes, stream); }); \
    }
#define TANDEM_FIRST_HITS(name, with, tier) TANDEM_FIRST_HITS_OF(name, with, tier)  // expands the tier

TANDEM_FIRST_HITS(launch_first_hits, with_tracer, TANDEM_FIRST_HITS_TIER)
#if defined(TANDEM_FIRST_HITS_INSTANCED)
TANDEM_FIRST_HITS(launch_first_hits_instanced, with_instanced_tracer, TANDEM_FIRST_HITS_TIER)
#endif

}  // namespace tandem::cuda
