/// The CPU backend: Embree and TBB.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tandem/render/backend.h"

namespace tandem {

[[nodiscard]] std::unique_ptr<Backend> make_cpu_backend(const BackendOptions& options);

/// Why this processor cannot run it; empty if it can.
[[nodiscard]] std::string why_cpu_unavailable();

/// See cpu_instruction_sets() in tandem/backends/make_backend.h.
[[nodiscard]] std::vector<std::string> runnable_instruction_sets();

}  // namespace tandem
