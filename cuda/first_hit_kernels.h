/// The CUDA kernels that fill the planes of first hits, as templates over the Real of a tier (math/real.h).
#pragma once

#include "cuda/block_shape.h"
#include "cuda/launch.h"
#include "cuda/plane_kernels.h"
#include "cuda/with_tracer.h"
#include "tandem/kernel/first_hit.h"

namespace tandem::cuda {

template <class Real, class Tracer>
__global__ void __launch_bounds__(block_threads)
    first_hit_kernel(const __grid_constant__ Tracer tracer, const __grid_constant__ PixelJob job, std::size_t pixels,
                     const __grid_constant__ FilmPlanes planes) {
    const std::size_t pixel = static_cast<std::size_t>(blockIdx.x) * block_threads + threadIdx.x;
    if (pixel >= pixels) return;
    const auto number = static_cast<std::uint32_t>(pixel);
    const auto hits = find_first_hits<Real>(tracer, tracer.scene, job, number % job.width, number / job.width, true);
    keep(hits, 0, pixel, planes);
}

template <class Real, class Tracer>
void launch_first_hits(const Tracer& tracer, const PixelJob& job, std::uint32_t height, const FilmPlanes& planes,
                       cudaStream_t stream) {
    const std::size_t pixels = std::size_t{job.width} * height;
    launch("finding first hits", first_hit_kernel<Real, Tracer>, dim3(blocks_for(pixels, block_threads)), block_threads,
           stream, tracer, job, pixels, planes);
}

/// Starts the kernel that fits the scene. All hierarchies have the tracer for instances, which is one kernel less to
/// compile (docs/performance/build-time.md). In fast they have a tracer of their own, but scenes of instances have the
/// kernel of strict (first_hits() in cuda/plane_kernels.h).
template <class Real>
void fill_first_hits(const DeviceSceneView& scene, const PixelJob& job, std::uint32_t height, const FilmPlanes& planes,
                     DeviceCounters* counters, cudaStream_t stream) {
    const auto launch_with = [&](const auto& tracer) { launch_first_hits<Real>(tracer, job, height, planes, stream); };
    switch (structure_of(scene)) {
        case Structure::few:
            return launch_with(scene.few);
        case Structure::loop:
            return launch_with(LoopTracer{scene.scene});
        case Structure::bvh:
        case Structure::instanced:
            break;
    }
    if constexpr (is_fast<Real>) {
        launch_with(BvhTracer{scene.scene, counting_bvh(scene, counters)});
    } else {
        launch_with(instanced_tracer<HierarchyTracer>(scene, counters));
    }
}

}  // namespace tandem::cuda
