/// The CUDA backend.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tandem/render/backend.h"

namespace tandem {

/// Renders on the GPUs of `options.gpus`; several are a combined backend. Its calls make a GPU the current one of the
/// calling thread. Throws EnvironmentError if one of them does not exist.
[[nodiscard]] std::unique_ptr<Backend> make_cuda_backend(const BackendOptions& options);

/// The models of this machine's GPUs, by CUDA's numbers. Throws EnvironmentError if there is no driver.
[[nodiscard]] std::vector<std::string> cuda_gpu_names();

/// Why the backend cannot run; empty if there is a GPU with a driver that can run this build. Needs neither a GPU nor a
/// driver.
[[nodiscard]] std::string why_cuda_unavailable();

}  // namespace tandem
