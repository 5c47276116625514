/// Which rays to trace, and where the answers go.
#pragma once

#include <span>

#include "tandem/geometry/hit.h"
#include "tandem/math/ray.h"

namespace tandem {

struct TraceJob {
    std::span<const Ray<float>> rays;
    std::span<Hit> hits;         ///< as many as rays
    std::span<double> wide_t{};  ///< empty or as many: t before its rounding to float; 0 for a miss
};

/// The rays [first, first + count) of a job.
[[nodiscard]] inline TraceJob part(const TraceJob& job, std::size_t first, std::size_t count) {
    return {.rays = job.rays.subspan(first, count),
            .hits = job.hits.subspan(first, count),
            .wide_t = job.wide_t.empty() ? job.wide_t : job.wide_t.subspan(first, count)};
}

/// Throws InputError if the sizes do not fit.
void check(const TraceJob& job);

}  // namespace tandem
