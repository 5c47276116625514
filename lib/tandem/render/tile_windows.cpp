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

std::vector<FilmWindow> cut(const std::vector<FilmWindow>& windows, int tile_edge, std::size_t most) {
    std::vector<FilmWindow> small, left(windows.rbegin(), windows.rend());
    while (!left.empty()) {
        const FilmWindow window = left.back();
        left.pop_back();
        const int columns = (window.width - 1) / tile_edge + 1, rows = (window.height - 1) / tile_edge + 1;
        if (pixel_count(window) <= most || columns * rows == 1) {
            small.push_back(window);
            continue;
        }
        FilmWindow first = window, second = window;
        if (rows > 1) {
            first.height = rows / 2 * tile_edge;
            second.top += first.height;
            second.height -= first.height;
        } else {
            first.width = columns / 2 * tile_edge;
            second.left += first.width;
            second.width -= first.width;
        }
        left.insert(left.end(), {second, first});
    }
    return small;
}

}  // namespace tandem
