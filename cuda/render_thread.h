/// What a thread of a render kernel does: one pixel.
#pragma once

#include "cuda/block_shape.h"
#include "cuda/kernels.h"

namespace tandem::cuda {

template <class Effects, class Real, class Tracer>
__device__ __forceinline__ void render_thread(const Tracer& tracer, const PixelJob& job, std::uint32_t height,
                                              Vec3d* __restrict__ sums, DeviceCounters* __restrict__ counters) {
    const unsigned int warp = threadIdx.x / 32;
    const unsigned int lane = threadIdx.x % 32;
    const std::uint32_t x =
        blockIdx.x * block_width + warp % (block_width / warp_width) * warp_width + lane % warp_width;
    const std::uint32_t y =
        blockIdx.y * block_height + warp / (block_width / warp_width) * warp_height + lane / warp_width;
    if (x >= job.width || y >= height) return;
    const PixelSum<Real> pixel = render_pixel<Effects, Real>(tracer, tracer.scene, job, x, y, true);
    sums[static_cast<std::size_t>(y) * job.width + x] = pixel.sum;
    if (pixel.invalid != 0) atomicAdd(&counters->invalid_samples, pixel.invalid);
    if (pixel.lost_media != 0) atomicAdd(&counters->lost_media, pixel.lost_media);
}

}  // namespace tandem::cuda
