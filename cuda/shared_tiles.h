/// Tiles of shared pixels (shared_pixel.h) from a queue, for paths of one vertex whose code exceeds the instruction
/// caches. The threads of a warp take a sample each in rounds. All tiles have the same number of rounds, so the threads
/// of a block stay together.
#pragma once

#include "cuda/kernels.h"
#include "cuda/shared_pixel.h"

namespace tandem::cuda {

/// The tiles of a warp, as seen by one of its threads. All threads of the warp must call each function.
template <class Real>
class SharedTiles {
  public:
    __device__ __forceinline__ SharedTiles(const PixelJob& job, std::uint32_t height, DeviceCounters* counters)
        : job_(job),
          tiles_(tiles_of_window(job.width, height, warp_tile(job.sharing_threads))),
          height_(height),
          counters_(counters) {}

    /// Begins a round, and the path of this thread's sample if there is one.
    template <class Walk>
    __device__ __forceinline__ void begin_round(Walk& walk, const SceneView& scene) {
        if (first_ == job_.samples) take_tile();
        const std::uint32_t sample = first_ + thread();
        walk.begin_sample(scene, job_, at_.x, at_.y, job_.first_sample + sample, is_inside_ && sample < job_.samples);
    }

    /// Whether the round is the first of a tile; the same for all warps. Some thread then has a sample if any tile was
    /// left, because each tile has a pixel inside the window.
    [[nodiscard]] __device__ __forceinline__ bool begins_tile() const { return first_ == 0; }

    /// Ends the round. `radiance`: of this thread's sample; zero without one.
    __device__ __forceinline__ void end_round(const Vec3<Real>& radiance, Vec3d* __restrict__ sums) {
        const std::uint32_t threads = job_.sharing_threads;
        add_in_order(radiance, threads, min(threads, job_.samples - first_), sum_);
        first_ = min(first_ + threads, job_.samples);
        if (first_ < job_.samples || !is_inside_ || thread() != 0) return;
        sums[static_cast<std::size_t>(at_.y) * job_.width + at_.x] = sum_;
    }

  private:
    [[nodiscard]] __device__ __forceinline__ static std::uint32_t lane() { return threadIdx.x % 32; }
    /// The number of this thread among those that share its pixel, a power of two.
    [[nodiscard]] __device__ __forceinline__ std::uint32_t thread() const {
        return lane() & (job_.sharing_threads - 1);
    }

    /// The next tile; no pixel is inside the window if none is left.
    __device__ __forceinline__ void take_tile() {
        std::uint32_t tile = 0;
        if (lane() == 0) tile = atomicAdd(&counters_->next_in_queue, 1U);
        tile = __shfl_sync(0xFFFFFFFFU, tile, 0);
        at_ = tiles_.pixel(tile, lane() / job_.sharing_threads);
        is_inside_ = tile < tiles_.count && at_.x < job_.width && at_.y < height_;
        first_ = 0;
        sum_ = {};
    }

    const PixelJob& job_;
    WindowTiles tiles_;
    std::uint32_t height_;
    DeviceCounters* counters_;
    PixelPlace at_ = {0, 0};  ///< of this thread's pixel
    bool is_inside_ = false;
    std::uint32_t first_ = job_.samples;  ///< sample of the next round, from 0; all are done at first
    Vec3d sum_ = {};
};

}  // namespace tandem::cuda
