/// Rays of the second vertex of paths.
#pragma once

#include <vector>

#include "tandem/render/trace_job.h"

namespace tandem::bench {

/// Rays of one set, as a job needs them.
struct RaysToTrace {
    std::vector<Ray<float>> rays;
    std::vector<RaySource> sources;
    std::vector<RayEnd> ends;

    [[nodiscard]] TraceJob job(std::vector<Hit>& hits, RenderCounters& counters) const {
        return {.rays = rays, .hits = hits, .sources = sources, .ends = ends, .counters = &counters};
    }
};

/// The rays of a second vertex: from where `first` hit, in random directions on the side that it came from, or towards
/// one point light. A ray that missed gives a random ray. `edge`: as make_rays().
[[nodiscard]] RaysToTrace second_rays(const std::vector<Ray<float>>& first, const std::vector<Hit>& hits, int edge,
                                      bool shadow);

}  // namespace tandem::bench
