/// The thread layout of render kernels: one thread per pixel, several threads per pixel, or as many as the GPU can
/// hold, which take pixels from a queue.
#pragma once

#include <cuda_runtime_api.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "cuda/warp_tile.h"
#include "tandem/math/host_device.h"

namespace tandem::cuda {

// A block is four warps, whose tiles are side by side and above each other, so that their rays are coherent.
inline constexpr unsigned int block_threads = 128;

// The blocks of a kernel with a queue fill a multiprocessor: together they have as many threads as its registers allow,
// at most these.
inline constexpr unsigned int most_queue_threads = 512;

inline unsigned int blocks_for(std::size_t items, std::size_t per_block) {
    return static_cast<unsigned int>((items + per_block - 1) / per_block);
}

// A warp with a queue of its own (cuda/shared_queue.h) hands out sets of set_size samples. It begins a set only if
// fewer than waiting_sets sets wait for their last samples.
inline constexpr unsigned int set_size = 32;
inline constexpr unsigned int waiting_sets = 8;

struct RenderGrid {
    dim3 blocks;
    dim3 threads;
    std::size_t shared_bytes = 0;  ///< dynamic shared memory of a block
};

/// How many samples of a pixel to take at a time: the largest power of two, up to `most`, with which at most one place
/// in `places_per_gap` stays empty when the samples do not divide evenly. `most`: a power of two.
[[nodiscard]] TANDEM_HD constexpr std::uint32_t samples_at_a_time(std::uint32_t samples, std::uint32_t most,
                                                                  std::uint32_t places_per_gap) {
    std::uint32_t at_a_time = most;
    const auto places = [&] { return (std::uint64_t{samples - 1} / at_a_time + 1) * at_a_time; };
    while ((places() - samples) * places_per_gap > places()) at_a_time /= 2;
    return at_a_time;
}

/// How many threads share a pixel, for paths of one vertex (docs/performance/shared-pixels.md). In a
/// hierarchy of few primitives, rays through larger tiles visit the same nodes too; so fewer threads begin each pixel
/// and exchange its radiances, and an idle thread is worth less.
[[nodiscard]] inline std::uint32_t sharing_threads(std::uint32_t samples, std::size_t primitives) {
    constexpr std::size_t few = 256;  // measured: 4 threads are faster up to 100 primitives, 8 from 1000 on
    return primitives <= few ? samples_at_a_time(samples, 4, 16) : samples_at_a_time(samples, 8, 8);
}

/// How many samples of a pixel a set has, for longer paths.
[[nodiscard]] TANDEM_HD constexpr std::uint32_t samples_in_set(std::uint32_t samples) {
    return samples_at_a_time(samples, 8, 5);
}

/// The memory of paths in stages (cuda/staged_memory.h).
struct StagedMemory {
    std::uint32_t most_paths = 0;  ///< of a block
    std::size_t path_bytes = 0;    ///< of shared memory, for the records of a path
    std::size_t rare_bytes = 0;    ///< of device memory, likewise
};

/// How many paths in stages a block follows, up to `most`: several for each of its `threads`, but so few that each
/// place for a path has several pixels one after the other. Otherwise most places are empty while the last pixels end.
/// `pixels`: of each block. Measured on an H200 (docs/performance/paths.md).
[[nodiscard]] inline std::uint32_t staged_paths(std::uint64_t pixels, std::uint32_t threads, std::uint32_t most) {
    constexpr std::uint64_t least_pixels = 3;  // of a path
    const std::uint64_t per_thread = pixels / least_pixels / threads + 1;
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(per_thread * threads, most));
}

/// Blocks of 2 x 2 tiles. `threads`: of a block.
inline RenderGrid tiled_grid(std::uint32_t width, std::uint32_t height, WarpTile tile, dim3 threads) {
    return {dim3(blocks_for(width, 2 * tile.width()), blocks_for(height, 2 * tile.height())), threads};
}
inline RenderGrid thread_per_pixel(std::uint32_t width, std::uint32_t height) {
    return tiled_grid(width, height, warp_tile(1), dim3(block_threads));
}
inline RenderGrid shared_pixels(std::uint32_t width, std::uint32_t height, unsigned int threads) {
    return tiled_grid(width, height, warp_tile(threads), dim3(threads, block_threads / threads));
}

/// Of the current GPU.
[[nodiscard]] unsigned int multiprocessor_count();
/// A grid with this number of blocks on each multiprocessor of the current GPU; together these are as large as one
/// block of the kernel may be.
[[nodiscard]] RenderGrid pixel_queue(const void* kernel, unsigned int blocks_per_multiprocessor);
/// A grid for paths in stages: one block on each multiprocessor, with shared memory for its paths. Allows the kernel to
/// use as much.
[[nodiscard]] RenderGrid staged_grid(const void* kernel, const StagedMemory& memory, std::uint64_t pixels);

}  // namespace tandem::cuda
