/// The CUDA kernels that trace rays, as templates over the Real of a tier (math/real.h). Included by one .cu file per
/// tier, each compiled with the flags of its tier and with TANDEM_SHORT_PATHS (cuda/CMakeLists.txt).
#pragma once

#if !defined(TANDEM_SHORT_PATHS)
#error "compile it with TANDEM_SHORT_PATHS: the kernels that trace rays are slower by a tenth without"
#endif

#include "cuda/block_shape.h"
#include "cuda/launch.h"
#include "cuda/with_tracer.h"

namespace tandem::cuda {

/// The queries of a trace: nearest hits of rays that start in space or on surfaces, or whether shadow rays are blocked.
enum class Ask { nearest, nearest_from_surface, occluded };

template <class Real, Ask ask, class Tracer>
__global__ void __launch_bounds__(block_threads, resident_blocks<Real, Tracer>)
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

template <class Real>
void launch_trace(const DeviceSceneView& scene, const DeviceRays& rays, cudaStream_t stream) {
    if (rays.count == 0) return;
    with_tracer<Decisions::behind_walk>(scene, rays.counters, [&]<class Tracer>(const Tracer& tracer) {
        auto* kernel = rays.ends != nullptr      ? trace_kernel<Real, Ask::occluded, Tracer>
                       : rays.sources != nullptr ? trace_kernel<Real, Ask::nearest_from_surface, Tracer>
                                                 : trace_kernel<Real, Ask::nearest, Tracer>;
        launch("tracing rays", kernel, blocks_for(rays.count, block_threads), block_threads, stream, tracer, rays);
    });
}

}  // namespace tandem::cuda
