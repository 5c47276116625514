/// The render kernel that is specialised at load, for one way to find primitives. Included by linked_few.cu,
/// linked_loop.cu and linked_bvh.cu; each is compiled once per tier (TANDEM_LINKED_TIER) to LTO-IR of its own, so that
/// a link does not go through the code of the others.
#pragma once

#include "cuda/linked_facts.h"

extern "C" extern __device__ const tandem::cuda::LinkedFacts tandem_facts;
#define TANDEM_LINKED_KINDS tandem_facts.kinds
#define TANDEM_LINKED_LIGHT_KINDS tandem_facts.light_kinds

#include "cuda/render_thread.h"
#include "tandem/math/fast_math.h"

namespace tandem::cuda {

/// What the facts say, in the place of an EffectSet.
struct LinkedEffects {
    static constexpr EffectMask most = all_effects;

#if TANDEM_ON_DEVICE
    [[nodiscard]] TANDEM_HD static bool has_any(EffectMask of) { return (tandem_facts.effects & of.bits()) != 0; }
    [[nodiscard]] TANDEM_HD static std::uint32_t light_count(std::uint32_t count) {
        return tandem_facts.lights == LinkedFacts::any ? count : tandem_facts.lights;
    }
    [[nodiscard]] TANDEM_HD static PathLimits limits(const PathLimits&) {
        return {tandem_facts.reflection, tandem_facts.refraction, tandem_facts.diffuse};
    }
#else  // nvcc reads it for the host too, where the facts are not
    static bool has_any(EffectMask);
    static std::uint32_t light_count(std::uint32_t);
    static PathLimits limits(const PathLimits&);
#endif
    [[nodiscard]] TANDEM_HD static bool has(Effect effect) { return has_any(effect); }
};

/// The Reals of the tiers, by their names.
namespace linked_real {
using strict = float;
using precise = double;
using fast = FastFloat;
}  // namespace linked_real
using LinkedReal = linked_real::TANDEM_LINKED_TIER;

// Blocks that must fit on a multiprocessor, for paths of one vertex: measured on an H200 against 1, 3, 4, 6 and 8
// (docs/performance.md).
inline constexpr int short_path_blocks = std::is_same_v<LinkedReal, double> ? 4 : 6;

}  // namespace tandem::cuda

#define TANDEM_LINKED_KERNEL(Tracer)                                                                             \
    TANDEM_LINKED_ENTRY(Tracer, tandem_render_short, render_one, block_threads, tandem::cuda::short_path_blocks) \
    TANDEM_LINKED_ENTRY(Tracer, tandem_render_long, render_queue, queue_threads, 1)
#define TANDEM_LINKED_ENTRY(Tracer, name, render, threads, blocks)                                                 \
    extern "C" __global__ void __launch_bounds__(tandem::cuda::threads, blocks) name(                              \
        const __grid_constant__ Tracer tracer, const __grid_constant__ tandem::PixelJob job, std::uint32_t height, \
        tandem::Vec3d* __restrict__ sums, tandem::cuda::DeviceCounters* __restrict__ counters) {                   \
        using namespace tandem::cuda;                                                                              \
        render<LinkedEffects, LinkedReal>(tracer, job, height, sums, counters);                                    \
    }
