/// Frames rendered tile by tile, so that a render can stop between tiles and be resumed later, on any backend, with the
/// bits of an uninterrupted render.
#pragma once

#include <functional>

#include "tandem/render/motion_blur.h"
#include "tandem/render/tiled_film.h"

namespace tandem {

/// What a render of tiles has cost so far. Times do not include those of an earlier run.
struct TileCosts {
    RenderStats stats;
    PhaseTimes load;     ///< sums over all loads
    double prepare = 0;  ///< seconds of all preparations
};

/// The edge of tiles, in pixels, for renders that stop between them: a power of two from 16 to 512, so that a tile has
/// at most 2^25 samples. No bit depends on it.
[[nodiscard]] int tile_edge_for(int samples);

/// Renders the tiles that `film` lacks of the frame. A tile of a frame with motion blur has the samples of the first
/// instants, and gets those of the others, in the order of time. `after_tile` is called after each tile; once it
/// returns false, the tiles in progress, at most Backend::frames_in_flight(), are finished, and the function returns.
/// Returns whether the film is complete. Throws InputError if a tile has a number of samples at which no instant ends.
[[nodiscard]] bool render_tiles(Backend& backend, const Scene& scene, const FramePlan& plan, TiledFilm& film,
                                TileCosts& costs, const std::function<bool()>& after_tile);

}  // namespace tandem
