/// Distributes the pixels of a tile to lanes.
#pragma once

#include "cpu/kernels.h"
#include "tandem/math/lanes.h"

namespace tandem {

/// The pixels of a tile in nearly square blocks, of as many pixels as a packet has lanes, so that its rays are
/// coherent.
template <class Real>
class TilePixels {
  public:
    TANDEM_HD_INLINE explicit TilePixels(const Tile& tile) : tile_(tile), x_(tile.x0), y_(tile.y0) {}

    /// Assigns the next pixels to the lanes of `free`; returns the lanes that got one.
    TANDEM_HD_INLINE Mask<Real> next(const Mask<Real>& free, UInt<Real>& x, UInt<Real>& y) {
        UInt<Real> got(0U);
        for (int i = 0; i < Real::size; ++i) {
            if (!free[i] || !find()) continue;
            set_lane(x, i, x_ + at_ % width);
            set_lane(y, i, y_ + at_ / width);
            set_lane(got, i, 1U);
            ++at_;
        }
        return got != UInt<Real>(0U);
    }

  private:
    static constexpr std::uint32_t width = Real::size == 4 ? 2 : 4;

    /// Advances to the next pixel within the tile; false if there is none.
    TANDEM_HD_INLINE bool find() {
        while (true) {
            if (at_ == static_cast<std::uint32_t>(Real::size)) {
                at_ = 0;
                x_ += width;
                if (x_ >= tile_.x1) {
                    x_ = tile_.x0;
                    y_ += static_cast<std::uint32_t>(Real::size) / width;
                }
            }
            if (y_ >= tile_.y1) return false;
            if (x_ + at_ % width < tile_.x1 && y_ + at_ / width < tile_.y1) return true;
            ++at_;
        }
    }

    Tile tile_;
    std::uint32_t x_, y_;   // of the block
    std::uint32_t at_ = 0;  // within it
};

}  // namespace tandem
