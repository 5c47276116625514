/// Parts of films.
#pragma once

#include "tandem/film/film.h"
#include "tandem/render/render_job.h"

namespace tandem {

/// Copies the pixels of a window of `from`, with the planes of `to`, to the place there whose top left pixel is (left,
/// top). Throws InputError if `from` lacks a plane or if the window does not fit into either film.
void copy_window(Film& to, int left, int top, const Film& from, const FilmWindow& window);

}  // namespace tandem
