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
    std::uint32_t left, top;  ///< of the tile, in the window
    std::uint32_t first;      ///< the first of the samples, from 0
    std::uint32_t samples;    ///< of each pixel
};

/// What a warp works on, in shared memory.
struct SharedQueue {
    // constants
    SharedTile shape;
    std::uint32_t width_bits, pixel_bits;  ///< of the width and of the number of pixels, which are powers of two
    std::uint32_t most_samples;            ///< of a pixel in a set
    std::uint32_t across, tiles;

    SampleSet sets[waiting_sets];
    std::uint32_t open[waiting_sets];  ///< samples of the set that are not done
    std::uint32_t begun, added;        ///< numbers of sets
    std::uint32_t next;                ///< of the last set that began: the next item to hand out
    bool is_empty;                     ///< no tile is left
};

/// The queue of a warp, from the side of one of its threads. All of them must call each function except keep().
template <class Real>
class SharedSamples {
  public:
    /// `radiances`: of the warp, set_size for each waiting set.
    __device__ __forceinline__ SharedSamples(SharedQueue& queue, const PixelJob& job, std::uint32_t height,
                                             Vec3<Real>* radiances, DeviceCounters* counters)
        : queue_(queue), job_(job), height_(height), radiances_(radiances), counters_(counters) {
        if (lane() == 0) {
            const std::uint32_t threads = sharing_threads(job.samples);
            const SharedTile shape = shared_tile(threads);
            queue.shape = shape;
            queue.width_bits = __popc(shape.width - 1);
            queue.pixel_bits = __popc(shape.width * shape.height - 1);
            queue.most_samples = threads;
            queue.across = (job.width + shape.width - 1) / shape.width;
            queue.tiles = queue.across * ((height + shape.height - 1) / shape.height);
            queue.begun = queue.added = queue.next = 0;
            queue.is_empty = false;
        }
        __syncwarp();
    }

    /// Hands items to the threads that want one; take(x, y, sample) gets what there is.
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
                const std::uint32_t sample = item >> queue_.pixel_bits;
                const Place at = place(set, item & (pixels() - 1));
                if (at.is_inside) {
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

    /// The sample of this thread is done. Returns whether it is a number; otherwise nothing is added for it.
    __device__ __forceinline__ bool keep(const Vec3<Real>& radiance) {
        const Addend<Real> addend = addend_of(radiance);
        radiances_[item_] = addend.radiance;
        atomicSub(&queue_.open[item_ / set_size], 1U);
        return addend.is_number;
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
                const Place at = place(set, pixel);
                if (!at.is_inside) continue;
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
    struct Place {
        std::uint32_t x, y;
        bool is_inside;
    };

    static constexpr unsigned int all_ = 0xFFFFFFFFU;

    [[nodiscard]] __device__ __forceinline__ static unsigned int lane() { return threadIdx.x % 32; }
    [[nodiscard]] __device__ __forceinline__ std::uint32_t pixels() const { return 1U << queue_.pixel_bits; }
    [[nodiscard]] __device__ __forceinline__ const SampleSet& last() const {
        return queue_.sets[(queue_.begun - 1) % waiting_sets];
    }

    /// A pixel of the set's tile.
    [[nodiscard]] __device__ __forceinline__ Place place(const SampleSet& set, std::uint32_t pixel) const {
        const std::uint32_t x = set.left + (pixel & ((1U << queue_.width_bits) - 1U));
        const std::uint32_t y = set.top + (pixel >> queue_.width_bits);
        return {x, y, x < job_.width && y < height_};
    }

    /// Begins a set: the next samples of the tile, or the first ones of the next tile. False if there is none, or no
    /// place for one.
    __device__ __forceinline__ bool begin_set() {
        if (queue_.is_empty || queue_.begun - queue_.added == waiting_sets) return false;
        SampleSet set = {0, 0, job_.samples, 0};
        if (queue_.begun != 0) {
            set = last();
            set.first += set.samples;
        }
        if (set.first == job_.samples) {
            std::uint32_t tile = 0;
            if (lane() == 0) tile = atomicAdd(&counters_->next_in_queue, 1U);
            tile = __shfl_sync(all_, tile, 0);
            if (tile >= queue_.tiles) {
                __syncwarp();
                if (lane() == 0) queue_.is_empty = true;
                __syncwarp();
                return false;
            }
            const std::uint32_t down = tile / queue_.across;
            set = {(tile - down * queue_.across) * queue_.shape.width, down * queue_.shape.height, 0, 0};
        }
        set.samples = min(queue_.most_samples, job_.samples - set.first);
        const unsigned int inside = __ballot_sync(all_, lane() < pixels() && place(set, lane()).is_inside);
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
