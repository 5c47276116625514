/// Packets of samples of as few pixels as possible, so that their rays visit the same nodes of a hierarchy.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>

#include "cpu/kernels.h"
#include "cpu/tile_pixels.h"
#include "tandem/math/lanes.h"

namespace tandem {

/// The samples of a tile: all of a pixel, then all of the next one. A packet takes as many as it has lanes, so no lane
/// is idle before the end of the tile, whatever the number of samples.
template <class Real>
class SampleSequence {
  public:
    using Word = UInt<Real>;

    TANDEM_HD_INLINE SampleSequence(const PixelJob& job, const Tile& tile, Vec3d* sums)
        : job_(job), pixels_(tile), sums_(sums), begun_(job.samples) {}

    /// Takes the next samples; false if there are none.
    TANDEM_HD_INLINE bool next() {
        const Word lane = lane_index(Word(0U));
        const Word was_x = x_, was_y = y_;
        std::uint32_t taken = 0;
        for (run_count_ = 0; taken != size && (begun_ != job_.samples || begin_pixel()); ++run_count_) {
            const std::uint32_t count = std::min(size - taken, job_.samples - begun_);
            const Mask<Real> others = lane < Word(taken);
            x_ = select(others, x_, Word(at_x_));
            y_ = select(others, y_, Word(at_y_));
            sample_ = select(others, sample_, Word(job_.first_sample + begun_ - taken) + lane);
            begun_ += count;
            taken += count;
            runs_[run_count_] = {at_y_ * job_.width + at_x_, count, begun_ == job_.samples};
        }
        used_ = lane < Word(taken);
        has_new_pixels_ = any(x_ != was_x || y_ != was_y);
        return taken != 0;
    }

    /// Adds the radiances of these samples to the sums of their pixels, one after the other.
    TANDEM_HD_INLINE void add(const Vec3<Wide<Real>>& radiances) {
        // in memory, because taking lanes out of a vector one by one is slow
        double x[size], y[size], z[size];
        static_assert(sizeof(x) == sizeof(radiances.x));
        std::memcpy(x, &radiances.x, sizeof(x));
        std::memcpy(y, &radiances.y, sizeof(y));
        std::memcpy(z, &radiances.z, sizeof(z));
        std::uint32_t lane = 0;
        for (const Run* run = runs_; run != runs_ + run_count_; ++run) {
            for (const std::uint32_t end = lane + run->samples; lane != end; ++lane) {
                sum_ = sum_ + Vec3d{x[lane], y[lane], z[lane]};
            }
            if (!run->ends_pixel) continue;
            sums_[run->pixel] = sum_;
            sum_ = {0.0, 0.0, 0.0};
        }
    }

    [[nodiscard]] TANDEM_HD_INLINE const Word& x() const { return x_; }
    [[nodiscard]] TANDEM_HD_INLINE const Word& y() const { return y_; }
    [[nodiscard]] TANDEM_HD_INLINE const Word& sample() const { return sample_; }
    /// The lanes that have a sample.
    [[nodiscard]] TANDEM_HD_INLINE const Mask<Real>& used() const { return used_; }
    /// Whether any lane has another pixel than in the packet before.
    [[nodiscard]] TANDEM_HD_INLINE bool has_new_pixels() const { return has_new_pixels_; }

  private:
    static constexpr std::uint32_t size = Real::size, no_pixel = 0xFFFFFFFFU;

    /// Samples of one pixel in neighbouring lanes.
    struct Run {
        std::uint32_t pixel;  ///< its place in the film
        std::uint32_t samples;
        bool ends_pixel;
    };

    TANDEM_HD_INLINE bool begin_pixel() {
        if (!pixels_.next(at_x_, at_y_)) return false;
        begun_ = 0;
        return true;
    }

    const PixelJob& job_;
    TilePixels<Real> pixels_;
    Vec3d* sums_;
    // The pixel whose samples are taken, and how many are
    std::uint32_t at_x_ = 0, at_y_ = 0, begun_;
    // The packet
    Run runs_[size];
    std::uint32_t run_count_ = 0;
    Word x_{no_pixel}, y_{no_pixel}, sample_{0U};
    Mask<Real> used_{false};
    bool has_new_pixels_ = false;
    Vec3d sum_ = {0.0, 0.0, 0.0};  ///< of the first samples of a pixel
};

/// Paths of one vertex. The radiances of a pixel are added in the order of its samples, which gives the bits of one
/// lane per pixel.
template <class Effects, class Real, class Tracer>
TANDEM_HD TileStats render_shared_pixels(const Tracer& tracer, const SceneView& scene, const PixelJob& job,
                                         const Tile& tile, Vec3d* sums) {
    TileStats stats;
    PathTally<Real> tally;
    SampleSequence<Real> samples(job, tile, sums);
    SampleId<Real> id;
    PixelRays<Real> rays;
    while (samples.next()) {
        if (samples.has_new_pixels()) {
            id = sample_of<Real>(job, samples.x(), samples.y(), samples.sample());
            rays = rays_of_pixel<Real>(job, samples.x(), samples.y());
        }
        id.sample = samples.sample();
        const Vec3<Real> radiance =
            sample_radiance<Effects>(tracer, scene, job, rays, id, samples.used(), IndependentThreads(), tally);
        const Addend<Real> addend = addend_of(radiance);
        stats.counters.invalid_samples +=
            static_cast<std::uint64_t>(std::popcount((samples.used() && !addend.is_number).bits()));
        samples.add(to_wide(addend.radiance));
    }
    stats.add(tally);
    return stats;
}

}  // namespace tandem
