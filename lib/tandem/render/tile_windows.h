/// Windows that cover some tiles of a grid.
#pragma once

#include <vector>

#include "tandem/render/tile_grid.h"

namespace tandem {

/// Disjoint windows that cover exactly the tiles that are marked, as few as a search row by row finds: backends, GPUs
/// above all, render one large window faster than many small ones.
[[nodiscard]] std::vector<FilmWindow> windows_of(const TileGrid& grid, const std::vector<bool>& marked);

/// Cuts windows of whole tiles at borders of tiles, so that none has more pixels than `most`, or more than a tile.
[[nodiscard]] std::vector<FilmWindow> cut(const std::vector<FilmWindow>& windows, int tile_edge, std::size_t most);

}  // namespace tandem
