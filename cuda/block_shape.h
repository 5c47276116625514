/// The thread layout of kernels: one thread per pixel, or as many as the GPU can hold, which take pixels from a queue.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <cstdint>

namespace tandem::cuda {

// A block covers 16 x 8 pixels as four warps of 8 x 4, so that the rays of a warp are coherent.
inline constexpr unsigned int warp_width = 8;
inline constexpr unsigned int warp_height = 4;
inline constexpr unsigned int block_width = 16;
inline constexpr unsigned int block_height = 8;
inline constexpr unsigned int block_threads = block_width * block_height;

// The blocks of a kernel with a queue fill a multiprocessor: together they have as many threads as its registers allow,
// at most these.
inline constexpr unsigned int most_queue_threads = 512;

inline unsigned int blocks_for(std::size_t items, std::size_t per_block) {
    return static_cast<unsigned int>((items + per_block - 1) / per_block);
}

struct RenderGrid {
    dim3 blocks;
    unsigned int threads;
};
inline RenderGrid thread_per_pixel(std::uint32_t width, std::uint32_t height) {
    return {dim3(blocks_for(width, block_width), blocks_for(height, block_height)), block_threads};
}
/// Of the current GPU.
[[nodiscard]] unsigned int multiprocessor_count();
/// So many blocks for each multiprocessor of the current GPU, together as large as one block of the kernel may be.
[[nodiscard]] RenderGrid pixel_queue(const void* kernel, unsigned int blocks_per_multiprocessor);

}  // namespace tandem::cuda
