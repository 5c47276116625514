#include "tandem/render/traced_job.h"

#include <vector>

namespace tandem {

double trace_without_copies(std::span<const PrimitiveCopy> copies, const TraceJob& job,
                            const std::function<double(const TraceJob&)>& trace) {
    if (copies.empty()) return trace(job);
    const TracedIds ids(copies);
    std::vector<RaySource> sources(job.sources.begin(), job.sources.end());
    std::vector<RayEnd> ends(job.ends.begin(), job.ends.end());
    for (RaySource& source : sources) source.primitive = ids.traced(source.primitive);
    for (RayEnd& end : ends) end.light = ids.traced(end.light);
    TraceJob traced = job;
    traced.sources = sources;
    traced.ends = ends;
    const double seconds = trace(traced);
    for (Hit& hit : job.hits) hit.primitive = ids.of_scene(hit.primitive);
    return seconds;
}

}  // namespace tandem
