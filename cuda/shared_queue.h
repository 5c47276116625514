/// Pixels from a queue, for paths of several vertices: the threads of a warp share a tile of pixels, and each follows
/// the path of one sample at a time.
///
/// A warp takes the samples of its tile in sets. A thread whose path has ended takes the next sample of the set, so the
/// paths of a warp start in few pixels. The radiance of a sample waits in memory until all of its set are there; then
/// the samples of each pixel are added in their order, which gives the bits of one thread per pixel.
#pragma once

#include "cuda/block_shape.h"
#include "cuda/kernels.h"
#include "tandem/kernel/pixel.h"

namespace tandem::cuda {

/// Samples that a warp hands out together: some of each pixel of a tile. Sample s of pixel p is item s * pixels + p.
struct SampleSet {
    TilePlace tile;
    std::uint32_t first;    ///< the first of the samples, from 0
    std::uint32_t samples;  ///< of each pixel
};

/// What a warp works on, in shared memory.
struct SharedQueue {
    // constants
    WindowTiles tiles;
    std::uint32_t most_samples;  ///< of a pixel in a set

    SampleSet sets[waiting_sets];
    std::uint32_t open[waiting_sets];  ///< samples of the set that are not done
    std::uint32_t begun, added;        ///< numbers of sets
    std::uint32_t next;                ///< of the last set that began: the next item to hand out
    bool is_empty;                     ///< no tile is left
};

/// The queue of a warp, as seen by one of its threads. All threads of the warp must call each function except keep().
template <class Real>
class SharedSamples {
  public:
    /// `radiances`: of the warp, set_size for each waiting set.
    __device__ __forceinline__ SharedSamples(SharedQueue& queue, const PixelJob& job, std::uint32_t height,
                                             Vec3<Real>* radiances, DeviceCounters* counters)
        : queue_(queue), job_(job), height_(height), radiances_(radiances), counters_(counters) {}

    /// Call it before all others.
    __device__ __forceinline__ void open() {
        if (lane() == 0) {
            queue_.most_samples = samples_in_set(job_.samples);
            queue_.tiles = tiles_of_window(job_.width, height_, warp_tile(queue_.most_samples));
            queue_.begun = queue_.added = queue_.next = 0;
            queue_.is_empty = false;
        }
        __syncwarp();
    }

    /// Hands items to the threads that want one, if any are left, by calls of take(x, y, sample).
    template <class Take>
    __device__ __forceinline__ void hand_out(bool wants, Take take) {
        unsigned int waiting = __ballot_sync(all_, wants);
        while (waiting != 0) {
            if (queue_.begun == 0 || queue_.next == pixels() * last().samples) {
                if (!begin_set()) return;
            }
            const SampleSet& set = last();
            const std::uint32_t item = queue_.next + __popc(waiting & ((1U << lane()) - 1U));
            const bool gets = (waiting >> lane() & 1U) != 0 && item < pixels() * set.samples;
            if (gets) {
                const std::uint32_t sample = item >> queue_.tiles.tile.pixel_bits();
                const PixelPlace at = place(set, item & (pixels() - 1));
                if (is_inside(at)) {
                    item_ = (queue_.begun - 1) % waiting_sets * set_size + item;
                    take(at.x, at.y, job_.first_sample + set.first + sample);
                }
            }
            const unsigned int got = __ballot_sync(all_, gets);
            waiting &= ~got;
            __syncwarp();
            if (lane() == 0) queue_.next += __popc(got);
            __syncwarp();
        }
    }

    /// Keeps the radiance of this thread's sample, which is done.
    __device__ __forceinline__ void keep(const Vec3<Real>& radiance) {
        radiances_[item_] = radiance;
        atomicSub(&queue_.open[item_ / set_size], 1U);
    }

    /// Adds the sets that are done to the film, in their order.
    __device__ __forceinline__ void add_sets(Vec3d* __restrict__ sums) {
        __syncwarp();  // all threads see what any has kept
        while (queue_.added != queue_.begun && queue_.open[queue_.added % waiting_sets] == 0) {
            const std::uint32_t slot = queue_.added % waiting_sets;
            const SampleSet& set = queue_.sets[slot];
            // a thread for each channel of each pixel
            for (std::uint32_t i = lane(); i < 3 * pixels(); i += 32) {
                const std::uint32_t pixel = i / 3, channel = i - 3 * pixel;
                const PixelPlace at = place(set, pixel);
                if (!is_inside(at)) continue;
                double& total = (&sums->x)[3 * (static_cast<std::size_t>(at.y) * job_.width + at.x) + channel];
                const Real* from = &radiances_->x + 3 * (slot * set_size + pixel) + channel;
                double sum = set.first != 0 ? total : 0.0;
#pragma unroll 4
                for (std::uint32_t k = 0; k < set.samples; ++k) sum += to_wide(from[3 * pixels() * k]);
                total = sum;
            }
            __syncwarp();
            if (lane() == 0) ++queue_.added;
            __syncwarp();
        }
    }

  private:
    static constexpr unsigned int all_ = 0xFFFFFFFFU;

    [[nodiscard]] __device__ __forceinline__ static unsigned int lane() { return threadIdx.x % 32; }
    [[nodiscard]] __device__ __forceinline__ std::uint32_t pixels() const { return queue_.tiles.tile.pixels(); }
    [[nodiscard]] __device__ __forceinline__ const SampleSet& last() const {
        return queue_.sets[(queue_.begun - 1) % waiting_sets];
    }

    /// A pixel of the set's tile.
    [[nodiscard]] __device__ __forceinline__ PixelPlace place(const SampleSet& set, std::uint32_t pixel) const {
        return queue_.tiles.tile.pixel(set.tile, pixel);
    }
    [[nodiscard]] __device__ __forceinline__ bool is_inside(PixelPlace at) const {
        return at.x < job_.width && at.y < height_;
    }

    /// Begins a set: the next samples of the tile, or the first ones of the next tile. False if there is none, or no
    /// place for one.
    __device__ __forceinline__ bool begin_set() {
        if (queue_.is_empty || queue_.begun - queue_.added == waiting_sets) return false;
        SampleSet set = {{0, 0}, job_.samples, 0};
        if (queue_.begun != 0) {
            set = last();
            set.first += set.samples;
        }
        if (set.first == job_.samples) {
            std::uint32_t tile = 0;
            if (lane() == 0) tile = atomicAdd(&counters_->next_in_queue, 1U);
            tile = __shfl_sync(all_, tile, 0);
            if (tile >= queue_.tiles.count) {
                __syncwarp();
                if (lane() == 0) queue_.is_empty = true;
                __syncwarp();
                return false;
            }
            set = {queue_.tiles.place(tile), 0, 0};
        }
        set.samples = min(queue_.most_samples, job_.samples - set.first);
        const unsigned int inside = __ballot_sync(all_, lane() < pixels() && is_inside(place(set, lane())));
        __syncwarp();
        if (lane() == 0) {
            const std::uint32_t slot = queue_.begun % waiting_sets;
            queue_.sets[slot] = set;
            queue_.open[slot] = __popc(inside) * set.samples;
            queue_.next = 0;
            ++queue_.begun;
        }
        __syncwarp();
        return true;
    }

    SharedQueue& queue_;
    const PixelJob& job_;
    std::uint32_t height_;
    Vec3<Real>* radiances_;
    DeviceCounters* counters_;
    std::uint32_t item_ = 0;  ///< of this thread: the place of its radiance
};

}  // namespace tandem::cuda
