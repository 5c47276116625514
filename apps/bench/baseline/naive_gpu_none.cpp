// A build without nvcc: the naive CUDA renderer is missing and says so.
#include "naive_renderer.h"
#include "tandem/base/error.h"

namespace tandem::bench {

std::string naive_gpu_why_unavailable() { return "this build has no CUDA part (nvcc was not there)"; }

NaiveGpuTimes naive_gpu_render(const NaiveJob&, float*) { throw EnvironmentError(naive_gpu_why_unavailable()); }

}  // namespace tandem::bench
