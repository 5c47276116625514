/// Films in tiles.
#pragma once

#include <algorithm>
#include <cstddef>

#include "tandem/render/render_job.h"

namespace tandem {

[[nodiscard]] inline std::size_t pixel_count(const FilmWindow& window) {
    return static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
}

/// A film cut into square tiles, row by row from the top left. Those at the right and at the bottom may be smaller.
struct TileGrid {
    int width = 0, height = 0;  ///< of the film, pixels
    int edge = 1;               ///< of a tile, pixels

    [[nodiscard]] int columns() const { return (width - 1) / edge + 1; }
    [[nodiscard]] int rows() const { return (height - 1) / edge + 1; }
    [[nodiscard]] std::size_t count() const {
        return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows());
    }
    [[nodiscard]] FilmWindow tile(std::size_t index) const {
        const int left = static_cast<int>(index % static_cast<std::size_t>(columns())) * edge;
        const int top = static_cast<int>(index / static_cast<std::size_t>(columns())) * edge;
        return {left, top, std::min(edge, width - left), std::min(edge, height - top)};
    }
    friend bool operator==(const TileGrid&, const TileGrid&) = default;
};

}  // namespace tandem
