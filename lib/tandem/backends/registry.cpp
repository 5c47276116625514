#include "tandem/backends/registry.h"

#include <array>

#include "cpu/cpu_backend.h"
#include "tandem/backends/make_backend.h"
#include "tandem/oracle/oracle.h"
#if TANDEM_HAS_CUDA
#include "cuda/cuda_backend.h"
#else
#include "tandem/base/error.h"
#endif

namespace tandem {

namespace {

#if !TANDEM_HAS_CUDA
std::string why_cuda_unavailable() {
    return "this build has no CUDA backend; put nvcc 12.8 or newer on PATH and build again, or use --backend cpu";
}
std::unique_ptr<Backend> make_cuda_backend(const BackendOptions&) { throw EnvironmentError(why_cuda_unavailable()); }
std::vector<std::string> cuda_gpu_names() { return {}; }
#endif

constexpr std::array registry = {
    BackendEntry{"cpu", why_cpu_unavailable, make_cpu_backend, nullptr},
    BackendEntry{"cuda", why_cuda_unavailable, make_cuda_backend, cuda_gpu_names},
    BackendEntry{"oracle", [] { return std::string(); }, make_oracle_backend, nullptr},
};

}  // namespace

std::span<const BackendEntry> backend_registry() { return registry; }

std::vector<std::string> cpu_instruction_sets() { return runnable_instruction_sets(); }

}  // namespace tandem
