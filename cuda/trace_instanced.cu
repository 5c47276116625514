// The kernels that trace rays through scenes of instances, for one tier (TANDEM_TRACE_TIER). The tier fast has those of
// strict.
#include "cuda/tier_real.h"
#include "cuda/trace_kernels.h"

namespace tandem::cuda {

#define TANDEM_TRACE_JOINED(tier) trace_instanced_##tier
#define TANDEM_TRACE_NAME(tier) TANDEM_TRACE_JOINED(tier)

void TANDEM_TRACE_NAME(TANDEM_TRACE_TIER)(const DeviceSceneView& scene, const DeviceRays& rays, cudaStream_t stream) {
    using Real = tier_real::TANDEM_TRACE_TIER;
    const auto tracer = instanced_tracer<InstancedTracer>(scene, rays.counters);
    switch (ask_of(rays)) {
        case Ask::nearest:
            return launch_one<Real, Ask::nearest>(tracer, rays, stream);
        case Ask::nearest_from_surface:
            return launch_one<Real, Ask::nearest_from_surface>(tracer, rays, stream);
        case Ask::occluded:
            return launch_one<Real, Ask::occluded>(tracer, rays, stream);
    }
}

}  // namespace tandem::cuda
