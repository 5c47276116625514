// Adds samples that were rendered one by one, and their squares. One kernel for all tiers, compiled like strict.
#include "cuda/block_shape.h"
#include "cuda/launch.h"
#include "cuda/plane_kernels.h"
#include "tandem/kernel/moments.h"

namespace tandem::cuda {

namespace {

__global__ void __launch_bounds__(block_threads)
    add_samples_kernel(const Vec3d* __restrict__ samples, Vec3d* __restrict__ sums, Vec3d* __restrict__ squares,
                       std::size_t pixels) {
    const std::size_t i = static_cast<std::size_t>(blockIdx.x) * block_threads + threadIdx.x;
    if (i < pixels) add_sample(samples[i], sums[i], squares[i]);
}

}  // namespace

void add_samples(const Vec3d* samples, Vec3d* sums, Vec3d* squares, std::size_t pixels, cudaStream_t stream) {
    launch("adding samples", add_samples_kernel, dim3(blocks_for(pixels, block_threads)), block_threads, stream,
           samples, sums, squares, pixels);
}

}  // namespace tandem::cuda
