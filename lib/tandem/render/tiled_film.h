/// A film in tiles, each with samples of its own: for renders that are resumed later, and for adaptive sampling.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tandem/film/film.h"
#include "tandem/render/copy_window.h"
#include "tandem/render/tile_grid.h"

namespace tandem {

class TiledFilm {
  public:
    TiledFilm(const TileGrid& grid, PlaneMask planes) : grid_(grid), planes_(planes), tiles_(grid.count()) {}

    [[nodiscard]] const TileGrid& grid() const { return grid_; }
    [[nodiscard]] PlaneMask planes() const { return planes_; }
    /// The film of a tile; without pixels if the tile has no samples yet.
    [[nodiscard]] const Film& tile(std::size_t index) const { return tiles_[index]; }
    /// The samples per pixel of a tile so far.
    [[nodiscard]] int samples(std::size_t index) const { return tiles_[index].samples(); }
    [[nodiscard]] std::vector<int> samples() const;

    /// Adds the following samples of a tile. Their memory is copied, so that no buffer of a backend stays in use.
    /// Throws InputError if size or planes differ.
    void add(std::size_t index, const Film& later);

    /// The whole film. Every tile must have samples. If all have the same number, it is the film that a backend would
    /// have rendered at once; else its pixels have their own (Film::samples_of()). With the planes of `wanted` alone.
    [[nodiscard]] Film whole(PlaneMask wanted) const;
    [[nodiscard]] Film whole() const { return whole(planes_); }

  private:
    TileGrid grid_;
    PlaneMask planes_;
    std::vector<Film> tiles_;
};

/// Writes edge and samples per pixel of tiles: "32: 64*5 128" is a tile edge of 32 pixels, five tiles of 64 samples and
/// one of 128.
[[nodiscard]] std::string tile_samples_text(int edge, const std::vector<int>& samples);

struct TileSamples {
    TileGrid grid;
    std::vector<int> samples;  ///< per pixel of each tile
};

/// Parses the same for a film of that size. Throws InputError if it is malformed, or not for as many tiles.
[[nodiscard]] TileSamples parse_tile_samples(std::string_view text, int width, int height);

}  // namespace tandem
