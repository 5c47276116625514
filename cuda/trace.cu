// The kernels that trace rays, for one query (TANDEM_TRACE_ASK) and one tier (TANDEM_TRACE_TIER): cuda/CMakeLists.txt
// compiles this file for each of both, because nvcc takes long for all of them together.
#include "cuda/trace_kernels.h"
#include "tandem/math/fast_math.h"

namespace tandem::cuda {

namespace {

template <Tier tier>
using RealOf =
    std::conditional_t<tier == Tier::fast, FastFloat, std::conditional_t<tier == Tier::precise, double, float>>;

}  // namespace

#define TANDEM_TRACE_JOINED(ask, tier) trace_##ask##_##tier
#define TANDEM_TRACE_NAME(ask, tier) TANDEM_TRACE_JOINED(ask, tier)

void TANDEM_TRACE_NAME(TANDEM_TRACE_ASK, TANDEM_TRACE_TIER)(const DeviceSceneView& scene, const DeviceRays& rays,
                                                            cudaStream_t stream) {
    launch_trace<RealOf<Tier::TANDEM_TRACE_TIER>, Ask::TANDEM_TRACE_ASK>(scene, rays, stream);
}

}  // namespace tandem::cuda
