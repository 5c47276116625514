/// The CUDA kernels as templates over the Real of a tier (math/real.h). Included by one .cu file per tier, each
/// compiled with the flags of its tier (cuda/CMakeLists.txt).
#pragma once

#include <array>
#include <utility>

#include "cuda/kernels.h"
#include "cuda/launch.h"
#include "cuda/render_thread.h"

namespace tandem::cuda {

/// Blocks that must fit on a multiprocessor: 64 registers a thread. Measured on an H200 against 5, 6 and 7
/// (docs/performance.md): fewer leave double precision's latency uncovered, more spill.
template <class Real>
inline constexpr unsigned int resident_blocks = std::is_same_v<Real, double> ? 4 : 8;

template <class Effects>
inline constexpr bool has_queue = Effects::most.has_any(gathering_effects);

template <class Effects, class Real, class Tracer>
__global__ void __launch_bounds__(has_queue<Effects> ? queue_threads : block_threads,
                                  has_queue<Effects> ? 1 : resident_blocks<Real>)
    render_kernel(const __grid_constant__ Tracer tracer, const __grid_constant__ PixelJob job, std::uint32_t height,
                  Vec3d* __restrict__ sums, DeviceCounters* __restrict__ counters) {
    if constexpr (has_queue<Effects>) {
        render_queue<Effects, Real>(tracer, job, height, sums, counters);
    } else {
        render_one<Effects, Real>(tracer, job, height, sums, counters);
    }
}

/// What a trace asks: the nearest hits of rays that leave nothing, of rays that leave surfaces, or only whether shadow
/// rays are stopped.
enum class Ask { nearest, nearest_from_surface, occluded };

template <class Real, Ask ask, class Tracer>
__global__ void __launch_bounds__(block_threads, resident_blocks<Real>)
    trace_kernel(const __grid_constant__ Tracer tracer, const __grid_constant__ DeviceRays job) {
    const std::size_t i = static_cast<std::size_t>(blockIdx.x) * block_threads + threadIdx.x;
    if (i >= job.count) return;
    const Ray<float> ray = job.rays[i];
    const bool traceable = is_traceable(ray);
    if (!traceable) atomicAdd(&job.counters->rejected_rays, 1ULL);
    Closest<Real> closest = no_hit<Real>();
    if constexpr (ask == Ask::occluded) {
        ShadowSource<Real> source;
        if (job.sources != nullptr) static_cast<Source<Real>&>(source) = to_real<Real>(job.sources[i]);
        source.light = job.ends[i].light;
        const auto t_max = constant<Double<Real>>(job.ends[i].t);
        const bool occluded = tracer.occluded(to_real<Real>(ray), t_max, source, traceable);
        job.hits[i] = {0.0F, occluded ? some_primitive : no_primitive};
    } else {
        if constexpr (ask == Ask::nearest) {
            closest = tracer.closest(to_real<Real>(ray), NoSource{}, traceable);
        } else {
            closest = tracer.closest(to_real<Real>(ray), to_real<Real>(job.sources[i]), traceable);
        }
        job.hits[i] = to_hit(closest);
    }
    if (job.wide_t != nullptr) job.wide_t[i] = closest.primitive == no_primitive ? 0.0 : to_wide(closest.t);
}

/// Calls f with the tracer that fits the scene, which counts into `counters`.
template <class F>
auto with_tracer(const DeviceSceneView& scene, DeviceCounters* counters, F f) {
    constexpr std::uint32_t all = PrimitiveKinds::all, bodies = PrimitiveKinds::bodies;
    const bool faces = has_faces(scene.scene);
    switch (structure_of(scene)) {
        case Structure::few:
            return f(scene.few);
        case Structure::loop:
            return faces ? f(LoopTracerFor<all>{scene.scene}) : f(LoopTracerFor<bodies>{scene.scene});
        case Structure::bvh:
            break;
    }
    BvhView bvh = scene.bvh;
    bvh.stack_overflows = counters == nullptr ? nullptr : &counters->stack_overflows;
    return faces ? f(BvhTracerFor<all>{scene.scene, bvh}) : f(BvhTracerFor<bodies>{scene.scene, bvh});
}

/// Calls f with the render kernel of a variant and the tracer that it is for.
template <class Real, class F>
auto with_render_kernel(std::size_t variant, const DeviceSceneView& scene, DeviceCounters* counters, F f) {
    return with_tracer(scene, counters, [&]<class Tracer>(const Tracer& tracer) {
        using Kernel = decltype(&render_kernel<EffectSet<0>, Real, Tracer>);
        static constexpr auto kernels = []<std::size_t... i>(std::index_sequence<i...>) {
            return std::array<Kernel, sizeof...(i)>{
                render_kernel<EffectSet<variants[i].effects.bits()>, Real, Tracer>...};
        }
        (std::make_index_sequence<std::size(variants)>());
        return f(kernels[variant], tracer);
    });
}

template <class Real>
void launch_render(std::size_t variant, const DeviceSceneView& scene, const PixelJob& job, std::uint32_t height,
                   Vec3d* sums, DeviceCounters* counters, cudaStream_t stream) {
    const bool queued = variants[variant].effects.has_any(gathering_effects);
    const RenderGrid grid = queued ? pixel_queue() : thread_per_pixel(job.width, height);
    with_render_kernel<Real>(variant, scene, counters, [&](auto* kernel, const auto& tracer) {
        launch("rendering", kernel, grid.blocks, grid.threads, stream, tracer, job, height, sums, counters);
    });
}

template <class Real>
void launch_trace(const DeviceSceneView& scene, const DeviceRays& rays, cudaStream_t stream) {
    if (rays.count == 0) return;
    with_tracer(scene, rays.counters, [&]<class Tracer>(const Tracer& tracer) {
        auto* kernel = rays.ends != nullptr      ? trace_kernel<Real, Ask::occluded, Tracer>
                       : rays.sources != nullptr ? trace_kernel<Real, Ask::nearest_from_surface, Tracer>
                                                 : trace_kernel<Real, Ask::nearest, Tracer>;
        launch("tracing rays", kernel, blocks_for(rays.count, block_threads), block_threads, stream, tracer, rays);
    });
}

template <class Real>
KernelFacts render_kernel_facts(std::size_t variant, const DeviceSceneView& scene) {
    return with_render_kernel<Real>(variant, scene, nullptr, [](auto* kernel, const auto&) {
        return kernel_facts(reinterpret_cast<const void*>(kernel));
    });
}

template <class Real>
inline constexpr TierKernels tier_kernels = {launch_render<Real>, launch_trace<Real>, render_kernel_facts<Real>};

}  // namespace tandem::cuda
