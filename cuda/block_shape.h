/// The thread layout of kernels: one thread per pixel, or as many as the GPU can hold, which take pixels from a queue.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <cstdint>

namespace tandem::cuda {

inline constexpr unsigned int block_threads = 128;

// A warp covers a tile of 8 x 4 pixels, so that its rays are coherent. With one thread per pixel a block is one warp:
// whole blocks would wait for their slowest warp.
inline constexpr unsigned int warp_width = 8;
inline constexpr unsigned int warp_height = 4;
inline constexpr unsigned int warp_threads = warp_width * warp_height;

// One block of the kernels with a queue fills a multiprocessor, with 128 registers per thread.
inline constexpr unsigned int queue_threads = 512;

inline unsigned int blocks_for(std::size_t items, std::size_t per_block) {
    return static_cast<unsigned int>((items + per_block - 1) / per_block);
}

struct RenderGrid {
    dim3 blocks;
    unsigned int threads;
};
inline RenderGrid thread_per_pixel(std::uint32_t width, std::uint32_t height) {
    return {dim3(blocks_for(width, warp_width), blocks_for(height, warp_height)), warp_threads};
}
/// One block per multiprocessor of the current GPU.
[[nodiscard]] RenderGrid pixel_queue();

}  // namespace tandem::cuda
