/// The CPU kernels for the planes of first hits, compiled once per tier and instruction set.
#pragma once

#include "cpu/kernels.h"
#include "tandem/film/film_planes.h"

namespace tandem {

/// Writes the planes of first hits among `planes`, for the tile's pixels (rows of job.width).
using FirstHitKernel = void(const CpuSceneView& scene, const PixelJob& job, const Tile& tile, const FilmPlanes& planes);

/// Defined in cpu/kernels/first_hits.cpp.
template <class Isa, Tier tier>
void write_first_hits(const CpuSceneView& scene, const PixelJob& job, const Tile& tile, const FilmPlanes& planes);

}  // namespace tandem
