/// The samples of a tile's pixels, handed out in sets, and their radiances until they can be added in order.
#pragma once

#include <algorithm>
#include <array>

#include "cpu/kernels.h"
#include "cpu/tile_pixels.h"
#include "tandem/math/lanes.h"

namespace tandem {

/// A sample that a path is to follow.
struct SampleItem {
    std::uint32_t x, y;
    std::uint32_t sample;
    std::uint32_t place;  ///< of its radiance
};

/// Sets of some samples of a few pixels. Neighbouring lanes follow samples of one pixel, so that their rays visit the
/// same nodes of a hierarchy. When all samples of a set are done, those of each pixel are added in their order, which
/// gives the bits of one lane per pixel.
template <class Real>
class SampleSets {
  public:
    TANDEM_HD_INLINE SampleSets(const PixelJob& job, const Tile& tile, Vec3d* sums)
        : job_(job), pixels_(tile), sums_(sums) {}

    /// The next sample to follow; false if there is none, or none until others are done.
    TANDEM_HD_INLINE bool next(SampleItem& item) {
        if (next_ == 0 && !begin_set()) return false;
        const Set& set = sets_[(begun_ - 1) % set_count];
        const std::uint32_t index = set.pixels * set.samples - next_;
        const std::uint32_t pixel = index / set.samples, sample = index - pixel * set.samples;
        --next_;
        item = {set.x[pixel], set.y[pixel], job_.first_sample + set.first + sample,
                (begun_ - 1) % set_count * set_size + index};
        return true;
    }

    /// The radiance of a sample that is done.
    TANDEM_HD_INLINE void keep(std::uint32_t place, const Vec3d& radiance) {
        radiances_[place] = radiance;
        --sets_[place / set_size].open;
    }

    /// Adds the sets that are done to the sums.
    TANDEM_HD_INLINE void add_sets() {
        while (added_ != begun_ && sets_[added_ % set_count].open == 0) {
            const std::uint32_t slot = added_++ % set_count;
            const Set& set = sets_[slot];
            const Vec3d* radiance = radiances_.data() + slot * set_size;
            for (std::uint32_t pixel = 0; pixel < set.pixels; ++pixel) {
                Vec3d& at = sums_[set.y[pixel] * job_.width + set.x[pixel]];
                Vec3d sum = set.first == 0 ? Vec3d{0.0, 0.0, 0.0} : at;
                for (std::uint32_t i = 0; i < set.samples; ++i) sum = sum + *radiance++;
                at = sum;
            }
        }
    }

  private:
    static constexpr std::uint32_t most_samples = 8, set_size = most_samples * Real::size, set_count = 8;

    struct Set {
        std::array<std::uint32_t, Real::size> x, y;
        std::uint32_t pixels, first, samples;
        std::uint32_t open;  ///< samples that are not done
    };

    TANDEM_HD_INLINE bool begin_set() {
        if (begun_ - added_ == set_count) return false;
        const Set* last = begun_ == 0 ? nullptr : &sets_[(begun_ - 1) % set_count];
        Set& set = sets_[begun_ % set_count];
        if (last != nullptr && last->first + last->samples < job_.samples) {
            set.x = last->x;
            set.y = last->y;
            set.pixels = last->pixels;
            set.first = last->first + last->samples;
        } else {
            set.pixels = 0;
            while (set.pixels != Real::size && pixels_.next(set.x[set.pixels], set.y[set.pixels])) ++set.pixels;
            set.first = 0;
            if (set.pixels == 0) return false;
        }
        set.samples = std::min(most_samples, job_.samples - set.first);
        set.open = next_ = set.pixels * set.samples;
        ++begun_;
        return true;
    }

    const PixelJob& job_;
    TilePixels<Real> pixels_;
    Vec3d* sums_;
    std::uint32_t begun_ = 0, added_ = 0;  ///< numbers of sets
    std::uint32_t next_ = 0;               ///< samples of the last set that are not handed out
    std::array<Set, set_count> sets_;
    std::array<Vec3d, set_count * set_size> radiances_;
};

}  // namespace tandem
