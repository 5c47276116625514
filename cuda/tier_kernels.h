/// The kernels of a tier that are compiled ahead of time. Included by one .cu file per tier, each compiled with the
/// flags of its tier and with TANDEM_SHORT_PATHS (cuda/CMakeLists.txt).
#pragma once

#if !defined(TANDEM_SHORT_PATHS)
#error "compile this file with TANDEM_SHORT_PATHS: without it the kernels that trace rays are a tenth slower"
#endif

#include "cuda/render_kernels.h"
#include "cuda/trace_kernels.h"

namespace tandem::cuda {

// The variant with all effects is in kernels_*_full.cu, compiled without TANDEM_SHORT_PATHS.
#define TANDEM_TIER(name, promise) RenderKernel full_##name##_kernel();
#include "tandem/render/tiers.def"
#undef TANDEM_TIER

static_assert(std::size(variants) == 2 && !variants[0].effects.has_any(synchronising_effects),
              "the kernels of long paths have files of their own");

template <class Real>
TierKernels tier_kernels(RenderKernel full) {
    return {{compiled_render_kernel<0, Real>(), full}, launch_trace<Real>};
}

}  // namespace tandem::cuda
