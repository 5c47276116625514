/// One pixel whose samples several neighbouring threads of a warp compute.
///
/// Rays through one pixel differ less than rays through a tile of pixels. So the threads of a warp visit the same nodes
/// of a hierarchy, and fewer of them wait for others (docs/performance/shared-pixels.md).
#pragma once

#include <type_traits>

#include "cuda/block_shape.h"
#include "cuda/block_threads.h"
#include "tandem/kernel/pixel.h"

namespace tandem::cuda {

/// A pixel of the window, and the number of this thread among those that share it.
struct SharedPixel {
    PixelPlace at;
    std::uint32_t thread, threads;
};

/// A pixel of the tile of a warp of this block, in a launch of tiled_grid().
__device__ __forceinline__ PixelPlace pixel_in_block(WarpTile tile, std::uint32_t warp, std::uint32_t number) {
    return tile.pixel({blockIdx.x * 2 + warp % 2, blockIdx.y * 2 + warp / 2}, number);
}

/// The pixel of this thread in a launch of shared_pixels().
__device__ __forceinline__ SharedPixel shared_pixel() {
    const std::uint32_t threads = blockDim.x, number = threadIdx.y * threads + threadIdx.x;
    return {pixel_in_block(warp_tile(threads), number / 32, number % 32 / threads), threadIdx.x, threads};
}

/// Adds to `sum` what each of the `threads` that share a pixel gives, except those from number `end` on, in the order
/// of the threads: the bits that one thread would give. All threads of a warp must call it.
template <class Real>
__device__ __forceinline__ void add_in_order(const Vec3<Real>& own, std::uint32_t threads, std::uint32_t end,
                                             Vec3d& sum) {
    // A shuffle moves 32 bits, so doubles would take two.
    using Exchanged = std::conditional_t<std::is_same_v<Real, double>, double, float>;
    for (std::uint32_t i = 0; i < end; ++i) {
        const auto of = [&](const Real& channel) {
            const auto own_channel = static_cast<Exchanged>(to_wide(channel));
            return static_cast<double>(
                __shfl_sync(0xFFFFFFFFU, own_channel, static_cast<int>(i), static_cast<int>(threads)));
        };
        sum = sum + Vec3d{of(own.x), of(own.y), of(own.z)};
    }
}

/// The sum over the samples of a pixel, if it is inside the window. Each of its threads follows the path of one sample
/// at a time, and all add the radiances of these. `invalid` and `tally` are those of this thread's samples. All threads
/// of a warp must call it.
template <class Effects, class Real, class Tracer>
__device__ __forceinline__ PixelSum<Real> render_shared(const Tracer& tracer, const PixelJob& job,
                                                        const SharedPixel& pixel, bool is_inside) {
    SampleId<Real> id = sample_of<Real>(job, pixel.at.x, pixel.at.y, job.first_sample);
    const PixelRays<Real> rays = rays_of_pixel<Real>(job, pixel.at.x, pixel.at.y);
    PixelSum<Real> result;
    for (std::uint32_t first = 0; first < job.samples; first += pixel.threads) {
        const std::uint32_t sample = first + pixel.thread;
        const bool is_active = is_inside && sample < job.samples;
        id.sample = job.first_sample + sample;
        // also where no sample is left: the tracers need all threads of a warp
        const Addend<Real> own = addend_of(sample_radiance<Effects>(tracer, tracer.scene, job, rays, id, is_active,
                                                                    BlockThreads<Effects>(), result.tally));
        if (is_active && !own.is_number) ++result.invalid;
        add_in_order(own.radiance, pixel.threads, min(pixel.threads, job.samples - first), result.sum);
    }
    return result;
}

}  // namespace tandem::cuda
