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

    /// The next pixel; false if there is none.
    TANDEM_HD_INLINE bool next(std::uint32_t& x, std::uint32_t& y) {
        if (!find()) return false;
        x = x_ + at_ % width;
        y = y_ + at_ / width;
        ++at_;
        return true;
    }

    /// Assigns the next pixels to the lanes; returns those that got one.
    TANDEM_HD_INLINE Mask<Real> next(UInt<Real>& x, UInt<Real>& y) {
        UInt<Real> got(0U);
        std::uint32_t to_x, to_y;
        for (int i = 0; i < Real::size && next(to_x, to_y); ++i) {
            set_lane(x, i, to_x);
            set_lane(y, i, to_y);
            set_lane(got, i, 1U);
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
