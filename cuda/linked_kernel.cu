// The render kernel, to be linked with facts: for a scene when it is loaded, and for all scenes when Tandem is built
// (compiled_facts.cu). Compiled to LTO-IR once for each tier (TANDEM_LINKED_TIER), each tracer (TANDEM_LINKED_TRACER),
// and short and long paths, so that a link does not process code that it does not need.
//
// TANDEM_SHORT_PATHS is defined for paths of one vertex, without synchronising_effects. Their code fits into the
// instruction caches, and TANDEM_HD_CALL_ON(device) is inline. TANDEM_HAS_STAGES is defined if the kernel can follow
// paths in stages.
#include "cuda/linked_facts.h"

extern "C" extern __device__ const tandem::cuda::LinkedFacts tandem_facts;
#define TANDEM_LINKED_KINDS tandem_facts.kinds
#define TANDEM_LINKED_LIGHT_KINDS tandem_facts.light_kinds
#define TANDEM_LINKED_AREA_LIGHTS tandem_facts.area_lights
#define TANDEM_LINKED_ANY_SCENE (tandem_facts.reflection == tandem::cuda::LinkedFacts::any)
#define TANDEM_LINKED_SEVERAL_SLOTS tandem_facts.several_slots
#define TANDEM_LINKED_CUTOUT_KINDS tandem_facts.cutout_kinds
#define TANDEM_LINKED_MASKED_KINDS tandem_facts.masked_kinds
#define TANDEM_LINKED_SAMPLER tandem_facts.sampler
#define TANDEM_LINKED_FILTER tandem_facts.filter

#include "cuda/render_thread.h"
#include "cuda/tier_real.h"

namespace tandem::cuda {

/// Takes the place of an EffectSet, from the linked facts.
struct LinkedEffects {
#if defined(TANDEM_SHORT_PATHS)
    static constexpr EffectMask most = all_effects - synchronising_effects;
#else
    static constexpr EffectMask most = all_effects;
#endif

#if TANDEM_ON_DEVICE
    [[nodiscard]] TANDEM_HD static bool has_any(EffectMask of) {
        return (tandem_facts.effects & (most & of).bits()) != 0;
    }
    [[nodiscard]] TANDEM_HD static std::uint32_t light_count(std::uint32_t count) {
        return either(tandem_facts.lights, count);
    }
    [[nodiscard]] TANDEM_HD static PathLimits limits(const PathLimits& given) {
        return {either(tandem_facts.reflection, given.reflection), either(tandem_facts.refraction, given.refraction),
                either(tandem_facts.diffuse, given.diffuse)};
    }
#else  // nvcc also compiles this for the host, which has no facts
    static bool has_any(EffectMask);
    static std::uint32_t light_count(std::uint32_t);
    static PathLimits limits(const PathLimits&);
#endif
    [[nodiscard]] TANDEM_HD static bool has(Effect effect) { return has_any(effect); }

  private:
    /// The fact, or the argument of the kernel if the fact is LinkedFacts::any.
    [[nodiscard]] TANDEM_HD static std::uint32_t either(std::uint32_t fact, std::uint32_t given) {
        return fact == LinkedFacts::any ? given : fact;
    }
};

using LinkedReal = tier_real::TANDEM_LINKED_TIER;

#if defined(TANDEM_SHORT_PATHS)
// Blocks per multiprocessor: measured on an H200 against 1, 3, 4, 6 and 8 (docs/performance/paths.md).
#define TANDEM_LINKED_BOUNDS __launch_bounds__(block_threads, std::is_same_v<LinkedReal, double> ? 4 : 6)
#else
// None: the link limits registers (most_registers() in scene_kernels.cpp), and registers limit threads (pixel_queue()).
#define TANDEM_LINKED_BOUNDS
#endif

extern "C" __global__ void TANDEM_LINKED_BOUNDS tandem_render(const __grid_constant__ TANDEM_LINKED_TRACER tracer,
                                                              const __grid_constant__ PixelJob job,
                                                              std::uint32_t height, Vec3d* __restrict__ sums,
                                                              void* __restrict__ radiances,
                                                              DeviceCounters* __restrict__ counters) {
#if TANDEM_ON_DEVICE && !defined(TANDEM_SHORT_PATHS) && __CUDACC_VER_MAJOR__ >= 13
    // Spills registers to shared memory first, most of which is otherwise unused (docs/performance/paths.md, "Registers
    // of kernels for long paths"), except by paths in stages.
    if (tandem_facts.in_stages == 0) asm volatile(".pragma \"enable_smem_spilling\";");
#endif
#if defined(TANDEM_SHORT_PATHS)
    render_short<LinkedEffects, LinkedReal>(tracer, job, height, sums, counters);
#else
#if defined(TANDEM_HAS_STAGES)
    if (tandem_facts.in_stages != 0) {
        return render_in_stages<LinkedEffects, LinkedReal>(tracer, job, height, sums, radiances, counters);
    }
#endif
    render_long<LinkedEffects, LinkedReal>(tracer, job, height, sums, radiances, counters);
#endif
}

}  // namespace tandem::cuda
