/// The render kernels that are compiled ahead of time, as templates over the Real of a tier (math/real.h).
#pragma once

#include "cuda/launch.h"
#include "cuda/render_thread.h"
#include "cuda/with_tracer.h"

namespace tandem::cuda {

template <class Effects>
inline constexpr bool has_queue = Effects::most.has_any(synchronising_effects);

template <class Effects, class Real, class Tracer>
__global__ void __launch_bounds__(has_queue<Effects> ? queue_threads : block_threads,
                                  has_queue<Effects> ? 1 : resident_blocks<Real, Tracer>)
    render_kernel(const __grid_constant__ Tracer tracer, const __grid_constant__ PixelJob job, std::uint32_t height,
                  Vec3d* __restrict__ sums, DeviceCounters* __restrict__ counters) {
    if constexpr (has_queue<Effects>) {
        render_queue<Effects, Real>(tracer, job, height, sums, counters);
    } else {
        render_one<Effects, Real>(tracer, job, height, sums, counters);
    }
}

template <class Effects, class Real>
void launch_render(const DeviceSceneView& scene, const PixelJob& job, std::uint32_t height, Vec3d* sums,
                   DeviceCounters* counters, cudaStream_t stream) {
    const RenderGrid grid = has_queue<Effects> ? pixel_queue() : thread_per_pixel(job.width, height);
    with_tracer(scene, counters, [&]<class Tracer>(const Tracer& tracer) {
        launch("rendering", render_kernel<Effects, Real, Tracer>, grid.blocks, grid.threads, stream, tracer, job,
               height, sums, counters);
    });
}

template <class Effects, class Real>
KernelFacts render_kernel_facts(const DeviceSceneView& scene) {
    return with_tracer(scene, nullptr, []<class Tracer>(const Tracer&) {
        return kernel_facts(reinterpret_cast<const void*>(&render_kernel<Effects, Real, Tracer>));
    });
}

/// The kernel of one of `variants`.
template <std::size_t variant, class Real>
RenderKernel compiled_render_kernel() {
    using Effects = EffectSet<variants[variant].effects.bits()>;
    return {launch_render<Effects, Real>, render_kernel_facts<Effects, Real>};
}

}  // namespace tandem::cuda
