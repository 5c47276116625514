#include "tandem/render/trace_job.h"

#include <fmt/format.h>

#include "tandem/base/error.h"

namespace tandem {

void check(const TraceJob& job) {
    const std::size_t rays = job.rays.size();
    if (job.hits.size() != rays) {
        throw InputError(fmt::format("trace: {} rays, but room for {} hits", rays, job.hits.size()));
    }
    const auto fits = [rays](std::size_t size, const char* what) {
        if (size != 0 && size != rays) throw InputError(fmt::format("trace: {} rays, but {} {}", rays, size, what));
    };
    fits(job.sources.size(), "sources");
    fits(job.ends.size(), "ends");
    fits(job.wide_t.size(), "elements of wide_t");
}

}  // namespace tandem
