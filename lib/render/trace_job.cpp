#include "tandem/render/trace_job.h"

#include <fmt/format.h>

#include "tandem/error/error.h"

namespace tandem {

void check(const TraceJob& job) {
    if (job.hits.size() != job.rays.size()) {
        throw InputError(fmt::format("trace: {} rays, but room for {} hits", job.rays.size(), job.hits.size()));
    }
    if (!job.wide_t.empty() && job.wide_t.size() != job.rays.size()) {
        throw InputError(
            fmt::format("trace: {} rays, but room for {} values of t in double", job.rays.size(), job.wide_t.size()));
    }
}

}  // namespace tandem
