/// A request to trace rays.
#pragma once

#include <span>

#include "tandem/kernel/shapes/ray_end.h"
#include "tandem/kernel/shapes/source.h"
#include "tandem/math/ray.h"
#include "tandem/render/stats.h"

namespace tandem {

/// Whether neighbouring rays have nearly the same origins and directions. This affects the speed only, not the bits.
enum class Coherence {
    unknown,  ///< the backend inspects some rays
    coherent,
    incoherent,
};

/// All spans except rays and hits may be empty; the others have as many elements.
struct TraceJob {
    std::span<const Ray<float>> rays;  ///< in render space (render_from_world())
    std::span<Hit> hits;
    std::span<const RaySource> sources{};  ///< the surfaces that the rays leave (kernel/spawn_ray.h)
    std::span<const RayEnd> ends{};        ///< not empty: shadow rays. A hit is {0, some_primitive}
    std::span<double> wide_t{};            ///< t before its rounding to float; 0 for a miss and for shadow rays
    Coherence coherence = Coherence::unknown;
    RenderCounters* counters = nullptr;  ///< rejected rays and stack overflows are added here unless it is null
};

/// The rays [first, first + count) of a job, without its counters: parts may run at the same time.
[[nodiscard]] inline TraceJob part(const TraceJob& job, std::size_t first, std::size_t count) {
    const auto cut = [&](auto span) { return span.empty() ? span : span.subspan(first, count); };
    return {.rays = cut(job.rays),
            .hits = cut(job.hits),
            .sources = cut(job.sources),
            .ends = cut(job.ends),
            .wide_t = cut(job.wide_t),
            .coherence = job.coherence};
}

/// Throws InputError if the sizes differ.
void check(const TraceJob& job);

}  // namespace tandem
