/// Completes the planes of a film after the kernels of any backend.
#pragma once

#include <span>

#include "tandem/compile/copies.h"
#include "tandem/film/film.h"
#include "tandem/render/render_job.h"

namespace tandem {

/// Fills the sample counts of a window of the film, and maps primitive ids to those of the caller: the backend traced
/// the scene without `copies`.
void complete_planes(Film& film, const FilmWindow& window, std::span<const PrimitiveCopy> copies);
inline void complete_planes(Film& film, std::span<const PrimitiveCopy> copies) {
    complete_planes(film, {0, 0, film.width(), film.height()}, copies);
}

}  // namespace tandem
