/// The CUDA backend.
#pragma once

#include <memory>

#include "tandem/render/backend.h"

namespace tandem {

[[nodiscard]] std::unique_ptr<Backend> make_cuda_backend(const BackendOptions& options);

/// Why the backend cannot run; empty if there is a GPU with a driver that can run this build. Needs neither itself.
[[nodiscard]] std::string why_cuda_unavailable();

}  // namespace tandem
