/// A render to a target, between two windows of its film.
#pragma once

#include <vector>

#include "tandem/render/tiled_film.h"

namespace tandem {

struct Round {
    std::vector<Film> fresh;  ///< by tile: the samples from which its error is estimated, with the plane variance
                              ///< alone: those of its last round so far, and after `was_last` all since that round; in
                              ///< the first round those of its last part, so that there are others
    std::vector<int> begins;  ///< by tile: the samples that it had before the round in progress
    std::vector<int> ends;    ///< by tile: the samples that it has after this round
    bool is_last = false;     ///< the round in progress is a last one
    bool was_last = false;    ///< a round before it was a last one
    double seconds = 0;       ///< of rendering, of all rounds so far
};

struct RoundState {
    TiledFilm film;  ///< all samples so far, with the plane variance
    Round round;
};

}  // namespace tandem
