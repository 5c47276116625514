/// Traces rays with a backend that leaves out a scene's copies (compile/copies.h), so that its ids differ from the
/// caller's.
#pragma once

#include <functional>

#include "tandem/compile/copies.h"
#include "tandem/render/trace_job.h"

namespace tandem {

/// Calls trace() with the job in the backend's ids, and changes the hits to the caller's. `copies`: those of the
/// prepared scene. Returns what trace() returns.
double trace_without_copies(std::span<const PrimitiveCopy> copies, const TraceJob& job,
                            const std::function<double(const TraceJob&)>& trace);

}  // namespace tandem
