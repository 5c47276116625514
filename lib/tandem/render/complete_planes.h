/// What all backends do alike for the planes of a film, when their kernels are done.
#pragma once

#include <span>

#include "tandem/compile/copies.h"
#include "tandem/film/film.h"

namespace tandem {

/// The numbers of samples, and of primitives as the caller knows them: the backend traced the scene without `copies`.
void complete_planes(Film& film, std::span<const PrimitiveCopy> copies);

}  // namespace tandem
