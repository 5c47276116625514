// For a build without nvcc: reports that the naive CUDA renderer is missing.
#include "naive_renderer.h"
#include "tandem/base/error.h"

namespace tandem::bench {

std::string naive_gpu_why_unavailable() {
    return "this build has no CUDA backend; put nvcc 12.8 or newer on PATH and build again";
}

NaiveGpuTimes naive_gpu_render(const NaiveJob&, float*) { throw EnvironmentError(naive_gpu_why_unavailable()); }

}  // namespace tandem::bench
