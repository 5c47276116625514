/// The CPU backend: Embree and TBB.
#pragma once

#include <memory>

#include "tandem/render/backend.h"

namespace tandem {

[[nodiscard]] std::unique_ptr<Backend> make_cpu_backend(const BackendOptions& options);

/// Why this processor cannot run it; empty if it can.
[[nodiscard]] std::string why_cpu_unavailable();

}  // namespace tandem
