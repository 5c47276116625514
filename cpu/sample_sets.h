/// The samples of a tile's pixels, handed out in sets, and their radiances until they can be added in order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>

#include "cpu/kernels.h"
#include "cpu/tile_pixels.h"
#include "tandem/math/lanes.h"

namespace tandem {

/// Samples that paths are to follow, one a lane.
template <class Real>
struct LaneSamples {
    UInt<Real> x{0U}, y{0U};
    UInt<Real> sample{0U};
    UInt<Real> place{0U};     ///< of its radiance
    Mask<Real> taken{false};  ///< the lanes that have one
};

/// Sets of some samples of a few pixels. Neighbouring lanes follow samples of one pixel, so that their rays visit the
/// same nodes of a hierarchy. When all samples of a set are done, those of each pixel are added in their order, which
/// gives the bits of one lane per pixel. Tested by tests/cpu/sample_sets_test.cpp.
template <class Real>
class SampleSets {
  public:
    using Word = UInt<Real>;

    TANDEM_HD_INLINE SampleSets(const PixelJob& job, const Tile& tile, Vec3d* sums)
        : job_(job), pixels_(tile), sums_(sums) {}

    /// The next samples, for the lanes of `free` in their order. Fewer if no samples are left, or none until others are
    /// done.
    TANDEM_HD_INLINE LaneSamples<Real> take(const Mask<Real>& free) {
        LaneSamples<Real> result;
        const Word rank = lanes_before(free);
        const auto wanted = static_cast<std::uint32_t>(std::popcount(free.bits()));
        for (std::uint32_t taken = 0; taken != wanted && (next_ != 0 || begin_set());) {
            const std::uint32_t slot = (begun_ - 1) % set_count;
            const Set& set = sets_[slot];
            const std::uint32_t count = std::min(wanted - taken, next_);
            const Word from_here = rank - Word(taken);  // wraps in the lanes that have a sample
            const Mask<Real> here = free && from_here < Word(count);
            const Word index = select(here, from_here + Word(set.pixels * set.samples - next_), Word(0U));
            const Word pixel = (index * Word(set.inverse_samples)) >> inverse_bits;
            const Word first_sample(job_.first_sample + set.first);
            result.x = select(here, permute(set.x, pixel), result.x);
            result.y = select(here, permute(set.y, pixel), result.y);
            result.sample = select(here, first_sample + index - pixel * Word(set.samples), result.sample);
            result.place = select(here, Word(slot * set_size) + index, result.place);
            result.taken = result.taken || here;
            next_ -= count;
            taken += count;
        }
        return result;
    }

    /// The radiances of the samples of `done`, at their places.
    TANDEM_HD_INLINE void keep(const Word& places, const Vec3<Wide<Real>>& radiances, const Mask<Real>& done) {
        for (unsigned int rest = done.bits(); rest != 0; rest &= rest - 1) {
            const int i = lowest_bit(rest);
            radiances_[places[i]] = {radiances.x[i], radiances.y[i], radiances.z[i]};
        }
        for_each_unique_lane(places >> std::countr_zero(set_size), done,
                             [&](std::uint32_t slot, const Mask<Real>& of_set) {
                                 sets_[slot].open -= static_cast<std::uint32_t>(std::popcount(of_set.bits()));
                             });
    }

    /// Adds the sets that are done to the sums.
    TANDEM_HD_INLINE void add_sets() {
        while (added_ != begun_ && sets_[added_ % set_count].open == 0) {
            const std::uint32_t slot = added_++ % set_count;
            const Set& set = sets_[slot];
            const Vec3d* radiance = radiances_.data() + slot * set_size;
            for (int pixel = 0; pixel < static_cast<int>(set.pixels); ++pixel) {
                Vec3d& at = sums_[set.y[pixel] * job_.width + set.x[pixel]];
                Vec3d sum = set.first == 0 ? Vec3d{0.0, 0.0, 0.0} : at;
                for (std::uint32_t i = 0; i < set.samples; ++i) sum = sum + *radiance++;
                at = sum;
            }
        }
    }

  private:
    static constexpr int inverse_bits = 16;
    static constexpr std::uint32_t most_samples = 8, set_size = most_samples * Real::size, set_count = 8;

    struct Set {
        Word x, y;  ///< of the pixels
        std::uint32_t pixels, first, samples;
        std::uint32_t inverse_samples;  ///< 2^inverse_bits / samples, rounded up: gives exact quotients below set_size
        std::uint32_t open;             ///< samples that are not done
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
            set.pixels = static_cast<std::uint32_t>(std::popcount(pixels_.next(set.x, set.y).bits()));
            set.first = 0;
            if (set.pixels == 0) return false;
        }
        set.samples = std::min(most_samples, job_.samples - set.first);
        set.inverse_samples = ((1U << inverse_bits) + set.samples - 1) / set.samples;
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
