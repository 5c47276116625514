/// Completes the planes of a film after the kernels of any backend.
#pragma once

#include <span>

#include "tandem/compile/copies.h"
#include "tandem/film/film.h"

namespace tandem {

/// Fills the sample counts, and maps primitive ids to those of the caller: the backend traced the scene without
/// `copies`.
void complete_planes(Film& film, std::span<const PrimitiveCopy> copies);

}  // namespace tandem
