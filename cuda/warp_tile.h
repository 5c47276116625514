/// The pixels of a window that the threads of a warp render together.
#pragma once

#include <cstdint>

#include "tandem/math/host_device.h"

namespace tandem::cuda {

/// A pixel of the window, or one beyond its right or lower edge.
struct PixelPlace {
    std::uint32_t x, y;
};

/// The place of a tile among those of the window.
struct TilePlace {
    std::uint32_t column, row;
};

/// A rectangle of pixels; its width and height are powers of two.
struct WarpTile {
    std::uint32_t width_bits, height_bits;

    [[nodiscard]] TANDEM_HD constexpr std::uint32_t width() const { return 1U << width_bits; }
    [[nodiscard]] TANDEM_HD constexpr std::uint32_t height() const { return 1U << height_bits; }
    [[nodiscard]] TANDEM_HD constexpr std::uint32_t pixel_bits() const { return width_bits + height_bits; }
    [[nodiscard]] TANDEM_HD constexpr std::uint32_t pixels() const { return 1U << pixel_bits(); }

    /// Pixel `number` of a tile; pixels are numbered row by row.
    [[nodiscard]] TANDEM_HD constexpr PixelPlace pixel(TilePlace at, std::uint32_t number) const {
        return {(at.column << width_bits) + (number & (width() - 1U)),
                (at.row << height_bits) + (number >> width_bits)};
    }
};

/// The tile of a warp if `threads` share each pixel, a power of two up to 32: a square, or two side by side.
[[nodiscard]] TANDEM_HD constexpr WarpTile warp_tile(unsigned int threads) {
    std::uint32_t bits = 0;
    while ((threads << bits) < 32) ++bits;
    return {(bits + 1) / 2, bits / 2};
}

/// The tiles that cover a window, numbered row by row from the top left.
struct WindowTiles {
    WarpTile tile;
    std::uint32_t across, count;

    /// Column and row of tile `number`.
    [[nodiscard]] TANDEM_HD constexpr TilePlace place(std::uint32_t number) const {
        const std::uint32_t row = number / across;
        return {number - row * across, row};
    }
    /// Pixel `pixel` of tile `number`.
    [[nodiscard]] TANDEM_HD constexpr PixelPlace pixel(std::uint32_t number, std::uint32_t pixel) const {
        return tile.pixel(place(number), pixel);
    }
};

[[nodiscard]] TANDEM_HD constexpr WindowTiles tiles_of_window(std::uint32_t width, std::uint32_t height,
                                                              WarpTile tile) {
    const std::uint32_t across = (width + tile.width() - 1) / tile.width();
    return {tile, across, across * ((height + tile.height() - 1) / tile.height())};
}

}  // namespace tandem::cuda
