/// The CUDA kernels that trace rays, as templates over the Real of a tier (math/real.h) and the query. trace.cu and
/// trace_instanced.cu instantiate them, compiled with the flags of each tier and with TANDEM_SHORT_PATHS
/// (cuda/CMakeLists.txt).
#pragma once

#if !defined(TANDEM_SHORT_PATHS)
#error "compile it with TANDEM_SHORT_PATHS: the kernels that trace rays are slower by a tenth without"
#endif

#include "cuda/refill_kernels.h"

namespace tandem::cuda {

/// Resident blocks per multiprocessor. A traversal with deferred decisions needs fewer registers than the decisions.
template <class Real, class Tracer>
inline constexpr unsigned int trace_blocks = [] {
    if (!can_refill<Tracer> || !std::is_same_v<Real, float>) return resident_blocks<Real, Tracer>;
    if (Tracer::kinds == PrimitiveKinds::sphere || Tracer::kinds == PrimitiveKinds::parallelepiped) return 10U;
    return Tracer::kinds == PrimitiveKinds::triangle ? 8U : resident_blocks<Real, Tracer>;
}();

template <class Real, Ask ask, class Tracer>
__global__ void __launch_bounds__(block_threads, trace_blocks<Real, Tracer>)
    trace_kernel(const __grid_constant__ Tracer tracer, const __grid_constant__ DeviceRays job) {
    const std::size_t place = static_cast<std::size_t>(blockIdx.x) * block_threads + threadIdx.x;
    if (place >= job.count) return;
    const std::size_t i = ray_at(job, place);
    const Ray<float> ray = load_ray(job, i);
    const bool traceable = is_traceable(ray);
    if (!traceable) atomicAdd(&job.counters->rejected_rays, 1ULL);
    const auto source = source_of<Real, ask>(job, i);
    if constexpr (ask == Ask::occluded) {
        const auto t_max = constant<Double<Real>>(job.ends[i].t);
        write_shadow(job, i, tracer.occluded(to_real<Real>(ray), t_max, source, traceable));
    } else {
        write_hit(job, i, tracer.closest(to_real<Real>(ray), source, traceable));
    }
}

/// One ray a thread.
template <class Real, Ask ask, class Tracer>
void launch_one(const Tracer& tracer, const DeviceRays& rays, cudaStream_t stream) {
    launch("tracing rays", trace_kernel<Real, ask, Tracer>, blocks_for(rays.count, block_threads), block_threads,
           stream, tracer, rays);
}

/// Rays that may diverge from their neighbours are traced by two kernels.
template <class Real, Ask ask, class Tracer>
void launch_best(const Tracer& tracer, const DeviceSceneView& scene, const DeviceRays& rays, cudaStream_t stream) {
    if constexpr (can_refill<Tracer> && !is_fast<Real>) {
        if (may_refill(scene, rays.are_coherent) && rays.count <= most_queued_rays) {
            return trace_with_refill<Real, ask>(tracer, rays, stream);
        }
    }
    launch_one<Real, ask>(tracer, rays, stream);
}

/// In a scene without instances.
template <class Real, Ask ask>
void launch_trace(const DeviceSceneView& scene, const DeviceRays& rays, cudaStream_t stream) {
    if (rays.count == 0) return;
    with_tracer(scene, rays.counters, [&]<class Tracer>(const Tracer& tracer) {
        if constexpr (is_fast<Real> && can_refill<Tracer> && ask != Ask::occluded) {
            // Decisions in leaves are slower for incoherent rays even in float alone, and the hits of a ray must not
            // depend on the others that it is traced with.
            trace_kernels(Structure::bvh, Tier::strict, ask)(scene, rays, stream);
        } else {
            launch_best<Real, ask>(tracer, scene, rays, stream);
        }
    });
}

}  // namespace tandem::cuda
