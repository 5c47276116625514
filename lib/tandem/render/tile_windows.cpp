#include "tandem/render/tile_windows.h"

#include <algorithm>

namespace tandem {

std::vector<FilmWindow> windows_of(const TileGrid& grid, const std::vector<bool>& marked) {
    std::vector<FilmWindow> windows;
    const int columns = grid.columns();
    const auto index = [&](int column, int row) {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
    };
    for (int row = 0; row < grid.rows(); ++row) {
        for (int column = 0; column < columns;) {
            int end = column;
            while (end < columns && marked[index(end, row)]) ++end;
            if (end == column) {
                ++column;
                continue;
            }
            const FilmWindow first = grid.tile(index(column, row)), last = grid.tile(index(end - 1, row));
            const FilmWindow run{first.left, first.top, last.left + last.width - first.left, first.height};
            const auto above = std::find_if(windows.begin(), windows.end(), [&](const FilmWindow& other) {
                return other.left == run.left && other.width == run.width && other.top + other.height == run.top;
            });
            if (above == windows.end()) {
                windows.push_back(run);
            } else {
                above->height += run.height;
            }
            column = end;
        }
    }
    return windows;
}

}  // namespace tandem
