// The kernels that trace rays, for one tier (TANDEM_TRACE_TIER) and one query (TANDEM_TRACE_ASK), or for all queries if
// that is not defined. cuda/CMakeLists.txt compiles this file for each pair of an exact tier and a query, because nvcc
// takes long for all of them together. Scenes of instances have kernels of their own (trace_instanced.cu).
#include "cuda/tier_real.h"
#include "cuda/trace_kernels.h"

namespace tandem::cuda {

#define TANDEM_TRACE_OF(ask, tier)                                                                         \
    void trace_##ask##_##tier(const DeviceSceneView& scene, const DeviceRays& rays, cudaStream_t stream) { \
        launch_trace<tier_real::tier, Ask::ask>(scene, rays, stream);                                      \
    }
#define TANDEM_TRACE(ask, tier) TANDEM_TRACE_OF(ask, tier)  // expands both arguments

#if defined(TANDEM_TRACE_ASK)
TANDEM_TRACE(TANDEM_TRACE_ASK, TANDEM_TRACE_TIER)
#else
TANDEM_TRACE(nearest, TANDEM_TRACE_TIER)
TANDEM_TRACE(nearest_from_surface, TANDEM_TRACE_TIER)
TANDEM_TRACE(occluded, TANDEM_TRACE_TIER)
#endif

}  // namespace tandem::cuda
