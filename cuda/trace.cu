// The kernels that trace rays, for one query (TANDEM_TRACE_ASK) and one tier (TANDEM_TRACE_TIER): cuda/CMakeLists.txt
// compiles this file once for each pair, because nvcc takes long for all of them together. Scenes of instances have
// kernels of their own (trace_instanced.cu).
#include "cuda/tier_real.h"
#include "cuda/trace_kernels.h"

namespace tandem::cuda {

#define TANDEM_TRACE_JOINED(ask, tier) trace_##ask##_##tier
#define TANDEM_TRACE_NAME(ask, tier) TANDEM_TRACE_JOINED(ask, tier)

void TANDEM_TRACE_NAME(TANDEM_TRACE_ASK, TANDEM_TRACE_TIER)(const DeviceSceneView& scene, const DeviceRays& rays,
                                                            cudaStream_t stream) {
    launch_trace<tier_real::TANDEM_TRACE_TIER, Ask::TANDEM_TRACE_ASK>(scene, rays, stream);
}

}  // namespace tandem::cuda
