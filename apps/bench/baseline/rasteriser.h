/// The step below ray tracing: first hits from a z-buffer and direct light without shadows, on the CPU. Written
/// plainly, as a course on computer graphics teaches it: docs/paper.md, row 20.
#pragma once

#include <cstdint>
#include <vector>

#include "baseline/fill.h"
#include "baseline/raster_scene.h"
#include "tandem/film/film.h"

namespace tandem::bench {

struct RasterJob {
    int width = 1000;
    int height = 900;
    int samples = 100;       ///< per pixel; each is a pass over all triangles
    std::uint64_t seed = 0;  ///< shifts the places of the samples
    int threads = 0;         ///< 0 means one per core; they do not change the film
};

/// Passes with one sample per pixel, each at another place, the same in all pixels of a pass; the sums of the passes
/// are the film. Every pass has a z-buffer and shades what it shows: Phong's model with interpolated normals, the light
/// of punctual lights without shadows, ambient light, emission, the background. Threads share bands of rows.
/// Source of the passes: P. Haeberli, K. Akeley, "The Accumulation Buffer", SIGGRAPH 1990.
[[nodiscard]] Film rasterise(const RasterScene& scene, const RasterJob& job);

/// The places of the samples of a job, in their order: a shifted R2 sequence (M. Roberts, "The Unreasonable
/// Effectiveness of Quasirandom Sequences", 2018).
[[nodiscard]] std::vector<SamplePlace> sample_places(const RasterJob& job);

/// The triangle that each pixel shows at one place, and 0xFFFFFFFF where it shows none, row by row from the top left.
[[nodiscard]] std::vector<std::uint32_t> visible_triangles(const RasterScene& scene, int width, int height,
                                                           const SamplePlace& place);

}  // namespace tandem::bench
