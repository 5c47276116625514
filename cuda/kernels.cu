#include "cuda/kernels.h"

#include "cuda/launch.h"

namespace tandem::cuda {

namespace {

// A block covers 16 x 8 pixels as four warps of 8 x 4: neighbours in a warp see the same things.
constexpr unsigned int warp_width = 8;
constexpr unsigned int warp_height = 4;
constexpr unsigned int block_width = 16;
constexpr unsigned int block_height = 8;
constexpr unsigned int block_threads = block_width * block_height;
/// Blocks that must fit on a multiprocessor: 64 registers a thread. Measured on an H200 against 5, 6 and 7
/// (docs/performance.md): fewer leave double precision's latency uncovered, more spill.
constexpr unsigned int resident_blocks = 8;

template <class Tracer>
__global__ void __launch_bounds__(block_threads, resident_blocks)
    render_kernel(const __grid_constant__ Tracer tracer, const __grid_constant__ PixelJob job, std::uint32_t height,
                  Vec3d* __restrict__ sums, DeviceCounters* __restrict__ counters) {
    const unsigned int warp = threadIdx.x / 32;
    const unsigned int lane = threadIdx.x % 32;
    const std::uint32_t x =
        blockIdx.x * block_width + warp % (block_width / warp_width) * warp_width + lane % warp_width;
    const std::uint32_t y =
        blockIdx.y * block_height + warp / (block_width / warp_width) * warp_height + lane / warp_width;
    if (x >= job.width || y >= height) return;
    const PixelSum<float> pixel = render_pixel<float>(tracer, tracer.scene, job, x, y, true);
    sums[static_cast<std::size_t>(y) * job.width + x] = pixel.sum;
    if (pixel.invalid != 0) atomicAdd(&counters->invalid_samples, pixel.invalid);
}

/// What a trace asks: the nearest hits of rays that leave nothing, of rays that leave surfaces, or only whether shadow
/// rays are stopped.
enum class Ask { nearest, nearest_from_surface, occluded };

template <Ask ask, class Tracer>
__global__ void __launch_bounds__(block_threads, resident_blocks)
    trace_kernel(const __grid_constant__ Tracer tracer, const __grid_constant__ DeviceRays job) {
    const std::size_t i = static_cast<std::size_t>(blockIdx.x) * block_threads + threadIdx.x;
    if (i >= job.count) return;
    const Ray<float> ray = job.rays[i];
    const bool traceable = is_traceable(ray);
    if (!traceable) atomicAdd(&job.counters->rejected_rays, 1ULL);
    Closest<float> closest = no_hit<float>();
    if constexpr (ask == Ask::occluded) {
        ShadowSource<float> source;
        if (job.sources != nullptr) static_cast<RaySource&>(source) = job.sources[i];
        source.light = job.ends[i].light;
        const bool occluded = tracer.occluded(ray, job.ends[i].t, source, traceable);
        job.hits[i] = {0.0F, occluded ? some_primitive : no_primitive};
    } else {
        if constexpr (ask == Ask::nearest) {
            closest = tracer.closest(ray, NoSource{}, traceable);
        } else {
            closest = tracer.closest(ray, job.sources[i], traceable);
        }
        job.hits[i] = to_hit(closest);
    }
    if (job.wide_t != nullptr) job.wide_t[i] = closest.primitive == no_primitive ? 0.0 : closest.t;
}

/// Calls f with the tracer that fits the scene, which counts into `counters`.
template <class F>
auto with_tracer(const DeviceSceneView& scene, DeviceCounters* counters, F f) {
    switch (structure_of(scene)) {
        case Structure::few:
            return f(scene.few);
        case Structure::loop:
            return f(LoopTracer{scene.scene});
        case Structure::bvh:
            break;
    }
    BvhTracer tracer = {scene.scene, scene.bvh};
    tracer.bvh.stack_overflows = counters == nullptr ? nullptr : &counters->stack_overflows;
    return f(tracer);
}

unsigned int blocks_for(std::size_t items, std::size_t per_block) {
    return static_cast<unsigned int>((items + per_block - 1) / per_block);
}

}  // namespace

void launch_render(const DeviceSceneView& scene, const PixelJob& job, std::uint32_t height, Vec3d* sums,
                   DeviceCounters* counters, cudaStream_t stream) {
    const dim3 grid(blocks_for(job.width, block_width), blocks_for(height, block_height));
    with_tracer(scene, counters, [&]<class Tracer>(const Tracer& tracer) {
        launch("rendering", render_kernel<Tracer>, grid, block_threads, stream, tracer, job, height, sums, counters);
    });
}

void launch_trace(const DeviceSceneView& scene, const DeviceRays& rays, cudaStream_t stream) {
    if (rays.count == 0) return;
    with_tracer(scene, rays.counters, [&]<class Tracer>(const Tracer& tracer) {
        auto* kernel = rays.ends != nullptr      ? trace_kernel<Ask::occluded, Tracer>
                       : rays.sources != nullptr ? trace_kernel<Ask::nearest_from_surface, Tracer>
                                                 : trace_kernel<Ask::nearest, Tracer>;
        launch("tracing rays", kernel, blocks_for(rays.count, block_threads), block_threads, stream, tracer, rays);
    });
}

KernelFacts render_kernel_facts(const DeviceSceneView& scene) {
    return with_tracer(scene, nullptr, []<class Tracer>(const Tracer&) {
        cudaFuncAttributes attributes{};
        check(cudaFuncGetAttributes(&attributes, render_kernel<Tracer>), "reading the facts of a kernel");
        int blocks = 0;
        check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, render_kernel<Tracer>, block_threads, 0),
              "reading the occupancy of a kernel");
        int device = 0;
        int threads = 1;
        check(cudaGetDevice(&device), "finding the current GPU");
        check(cudaDeviceGetAttribute(&threads, cudaDevAttrMaxThreadsPerMultiProcessor, device), "reading GPU facts");
        return KernelFacts{attributes.numRegs, static_cast<int>(attributes.localSizeBytes),
                           static_cast<double>(blocks) * block_threads / threads};
    });
}

}  // namespace tandem::cuda
