/// A frame by the rasteriser, timed as those of backends.
#pragma once

#include "frame_timing.h"

namespace tandem::bench {

/// The phase `build` makes triangles of the scene; `render` projects, fills and shades them. The samples, the seed, the
/// frame and the size are those of the job. Throws as make_raster_scene() does.
[[nodiscard]] TimedFrame rasterise_timed(const Scene& scene, const RenderJob& job, int threads);

}  // namespace tandem::bench
