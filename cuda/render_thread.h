/// The work of a thread of a render kernel: one pixel, a part of its samples, or several pixels one after the other.
#pragma once

#include "cuda/block_lanes.h"
#include "cuda/block_shape.h"
#include "cuda/block_threads.h"
#include "cuda/kernels.h"
#include "cuda/shared_pixel.h"
#include "cuda/shared_queue.h"
#include "cuda/shared_tiles.h"
#include "cuda/staged_paths.h"
#include "tandem/kernel/certain_pixel.h"
#include "tandem/kernel/path_walk.h"
#include "tandem/kernel/pixel_culling.h"

namespace tandem::cuda {

/// `thread`: the number of this thread in its block.
template <class Effects, class Real>
__device__ __forceinline__ void count(const PixelSum<Real>& pixel, unsigned int thread,
                                      DeviceCounters* __restrict__ counters) {
    if (pixel.invalid != 0) atomicAdd(&counters->invalid_samples, pixel.invalid);
    if (pixel.tally.lost_media != 0) atomicAdd(&counters->lost_media, pixel.tally.lost_media);
    if (counts_rays<Effects>()) atomicAdd(&counters->rays[thread % ray_counters], pixel.tally.rays);
}

template <class Effects, class Real>
__device__ __forceinline__ void keep(const PixelSum<Real>& pixel, std::size_t at, Vec3d* __restrict__ sums,
                                     DeviceCounters* __restrict__ counters) {
    sums[at] = pixel.sum;
    count<Effects>(pixel, threadIdx.x, counters);
}

/// The slots of primitives that camera rays of a warp's tile may hit: each thread tests one slot, in double. This pays
/// from a few samples on. All threads of the warp call it.
template <class Effects>
__device__ __forceinline__ std::uint32_t slots_in_tile(const ConstantMemoryTracer& tracer, const PixelJob& job,
                                                       WarpTile tile, PixelPlace corner) {
    constexpr std::uint32_t least_samples = 8;
    if (job.samples < least_samples || !tracer.culls_pixels) return ConstantMemoryTracer::all_slots;
    const PixelTile pixels = {job.left + corner.x, job.top + corner.y, tile.width(), tile.height(),
                              reach_of(filter_of(job.filter))};
    const RayBundle rays = bundle_of_tile(job.camera, pixels, Effects::has(Effect::lens));
    static_assert(ConstantMemoryTracer::slot_count <= 32);
    const std::uint32_t slot = threadIdx.x % 32;
    const bool may = slot < ConstantMemoryTracer::slot_count && may_hit(tracer, rays, slot);
    return __ballot_sync(0xFFFFFFFFU, may);
}

/// A pixel whose camera rays may hit the primitives in `slots` alone.
template <class Effects, class Real>
__device__ __forceinline__ PixelSum<Real> render_among(const ConstantMemoryTracer& tracer, const PixelJob& job,
                                                       std::uint32_t x, std::uint32_t y, std::uint32_t slots) {
    if (!Effects::has_any(all_effects) && filter_of(job.filter) == PixelFilter::box) {
        const CertainView& view = tracer.certain;
        if (slots == 0 && view.is_finite_sky != 0) return render_sky<Effects, Real>(tracer.scene, job, x, y);
        if constexpr (!std::is_same_v<Real, double>) {
            if (view.is_valid != 0) {
                return render_certain_pixel<Effects, Real>(tracer, view, tracer.scene, job, x, y, slots);
            }
        }
    }
    const CulledTracer culled = {tracer, slots};
    return render_pixel<Effects, Real>(culled, tracer.scene, job, x, y, true, BlockThreads<Effects>());
}

/// Paths of one vertex where each primitive is tested: one pixel.
template <class Effects, class Real, class Tracer>
__device__ __forceinline__ void render_one(const Tracer& tracer, const PixelJob& job, std::uint32_t height,
                                           Vec3d* __restrict__ sums, DeviceCounters* __restrict__ counters) {
    constexpr WarpTile tile = warp_tile(1);
    const unsigned int warp = threadIdx.x / 32;
    const auto [x, y] = pixel_in_block(tile, warp, threadIdx.x % 32);
    std::uint32_t slots = 0;
    if constexpr (std::is_same_v<Tracer, ConstantMemoryTracer>) {
        slots = slots_in_tile<Effects>(tracer, job, tile, pixel_in_block(tile, warp, 0));
    }
    if (x >= job.width || y >= height) return;
    PixelSum<Real> pixel;
    if constexpr (std::is_same_v<Tracer, ConstantMemoryTracer>) {
        pixel = render_among<Effects, Real>(tracer, job, x, y, slots);
    } else {
        pixel = render_pixel<Effects, Real>(tracer, tracer.scene, job, x, y, true, BlockThreads<Effects>());
    }
    keep<Effects>(pixel, static_cast<std::size_t>(y) * job.width + x, sums, counters);
}

/// Paths of one vertex where primitives are found in a hierarchy: a pixel that this thread shares with others.
template <class Effects, class Real, class Tracer>
__device__ __forceinline__ void render_shared_pixel(const Tracer& tracer, const PixelJob& job, std::uint32_t height,
                                                    Vec3d* __restrict__ sums, DeviceCounters* __restrict__ counters) {
    const SharedPixel pixel = shared_pixel();
    const auto [x, y] = pixel.at;
    const bool is_inside = x < job.width && y < height;
    const PixelSum<Real> result = render_shared<Effects, Real>(tracer, job, pixel, is_inside);
    if (!is_inside) return;
    if (pixel.thread == 0) sums[static_cast<std::size_t>(y) * job.width + x] = result.sum;
    count<Effects>(result, threadIdx.y * blockDim.x + threadIdx.x, counters);
}

/// Paths of one vertex.
template <class Effects, class Real, class Tracer>
__device__ __forceinline__ void render_short(const Tracer& tracer, const PixelJob& job, std::uint32_t height,
                                             Vec3d* __restrict__ sums, DeviceCounters* __restrict__ counters) {
    if constexpr (Tracer::has_hierarchy) {
        render_shared_pixel<Effects, Real>(tracer, job, height, sums, counters);
    } else {
        render_one<Effects, Real>(tracer, job, height, sums, counters);
    }
}

/// Pixels from a queue, for longer paths (synchronising_effects): a thread that is finished takes the next pixel. The
/// threads of a block synchronise before each vertex, because the code of a vertex is larger than the instruction
/// caches: so the instructions are fetched once for all warps (docs/performance/paths.md). The assignment of pixels to
/// threads changes no bit.
template <class Effects, class Real, class Tracer>
__device__ __forceinline__ void render_queue(const Tracer& tracer, const PixelJob& job, std::uint32_t height,
                                             Vec3d* __restrict__ sums, DeviceCounters* __restrict__ counters) {
    const WindowTiles tiles = tiles_of_window(job.width, height, warp_tile(1));
    PathWalk<Effects, Real> walk;
    PixelSum<Real> pixel;
    bool is_open = true;
    while (true) {
        while (is_open && !walk.working()) {
            const std::uint32_t place = atomicAdd(&counters->next_in_queue, 1U);
            const auto [x, y] = tiles.pixel(place / 32, place % 32);
            is_open = place < tiles.count * 32;
            if (is_open && x < job.width && y < height) walk.take(job, x, y, true);
        }
        if (__syncthreads_or(walk.working()) == 0) return;
        const Closest<Real> hit = walk.find(tracer, tracer.scene, job, pixel.tally);
        if (!walk.leave(tracer, tracer.scene, job, hit, pixel.tally, BlockThreads<Effects>())) continue;
        add(walk.radiance(), pixel);
        if (walk.working()) continue;
        keep<Effects>(pixel, walk.pixel(job), sums, counters);
        pixel = {};
    }
}

/// Pixels from a queue, for long paths in stages. `rare`: records for each path, block after block.
template <class Effects, class Real, class Tracer>
__device__ __forceinline__ void render_in_stages(const Tracer& tracer, const PixelJob& job, std::uint32_t height,
                                                 Vec3d* __restrict__ sums, void* __restrict__ rare,
                                                 DeviceCounters* __restrict__ counters) {
    using Rare = RarePathRecords<Real>;
    extern __shared__ uint4 records[];
    __shared__ StageListsOf<Real> lists;
    std::uint32_t bytes = 0;
    asm("mov.u32 %0, %dynamic_smem_size;" : "=r"(bytes));
    const std::uint32_t count =
        min(bytes / static_cast<std::uint32_t>(PathRecords<Real>::bytes), most_staged_paths<Real>);
    StagedPaths<Effects, Real, Tracer, DeviceLanes> paths(
        tracer, job, height, PathRecords<Real>(records),
        static_cast<Rare*>(rare) + std::size_t{blockIdx.x} * most_staged_paths<Real>, lists, count,
        counters->next_in_queue, sums,
        StagedCounts{counters->rays[blockIdx.x % ray_counters], counters->lost_media, counters->invalid_samples});
    paths.run(PairPace<DeviceLanes>(counters->stages));
}

/// Paths in a hierarchy: the threads of a warp share pixels. SharedSamples hands out paths of several vertices, and
/// SharedTiles those of one vertex. One loop serves both, so that LTO-IR, which is compiled before the facts are known,
/// has the code of a path once. `radiances`: waiting_sets for each thread of the grid.
template <class Effects, class Real, class Tracer>
__device__ __forceinline__ void render_shared_queue(const Tracer& tracer, const PixelJob& job, std::uint32_t height,
                                                    Vec3d* __restrict__ sums, void* __restrict__ radiances,
                                                    DeviceCounters* __restrict__ counters) {
    static_assert(set_size == 32);
    __shared__ SharedQueue queues[most_queue_threads / 32];
    const std::size_t warps_before = std::size_t{blockIdx.x} * (blockDim.x / 32) + threadIdx.x / 32;
    SharedSamples<Real> samples(queues[threadIdx.x / 32], job, height,
                                static_cast<Vec3<Real>*>(radiances) + warps_before * (set_size * waiting_sets),
                                counters);
    SharedTiles<Real> tiles(job, height, counters);
    PathWalk<Effects, Real> walk;
    PixelSum<Real> counted;
    if (has_bounces<Effects>()) samples.open();
    while (true) {
        if (has_bounces<Effects>()) {
            samples.add_sets(sums);
            samples.hand_out(!walk.working(), [&](std::uint32_t x, std::uint32_t y, std::uint32_t sample) {
                walk.take_sample(x, y, sample, true);
            });
        } else {
            walk = {};  // so that the state of a path takes no registers between rounds
            tiles.begin_round(walk, tracer.scene);
        }
        const bool may_be_last = has_bounces<Effects>() || tiles.begins_tile();
        if (may_be_last && __syncthreads_or(walk.working()) == 0) break;
        if (has_bounces<Effects>()) walk.begin_next(tracer.scene, job);
        const Closest<Real> hit = walk.find_next(tracer, counted.tally);
        const bool ended = walk.leave(tracer, tracer.scene, job, hit, counted.tally, BlockThreads<Effects>());
        Addend<Real> addend = {{Real(0.0F), Real(0.0F), Real(0.0F)}, true};
        if (ended) {
            walk.stop(true);
            addend = addend_of(walk.radiance());
            if (!addend.is_number) ++counted.invalid;
        }
        if (!has_bounces<Effects>()) {
            tiles.end_round(addend.radiance, sums);
        } else if (ended) {
            samples.keep(addend.radiance);
        }
    }
    count<Effects>(counted, threadIdx.x, counters);
}

/// Paths of kernels with synchronising_effects.
template <class Effects, class Real, class Tracer>
__device__ __forceinline__ void render_long(const Tracer& tracer, const PixelJob& job, std::uint32_t height,
                                            Vec3d* __restrict__ sums, void* __restrict__ radiances,
                                            DeviceCounters* __restrict__ counters) {
    if constexpr (Tracer::has_hierarchy) {
        render_shared_queue<Effects, Real>(tracer, job, height, sums, radiances, counters);
    } else {
        render_queue<Effects, Real>(tracer, job, height, sums, counters);
    }
}

}  // namespace tandem::cuda
