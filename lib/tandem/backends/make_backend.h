/// Backends by name.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tandem/render/backend.h"

namespace tandem {

/// Makes "cpu", "cuda" or "oracle". Throws InputError for another name, and EnvironmentError, with the reason, for a
/// backend that this build or this machine cannot run.
[[nodiscard]] std::unique_ptr<Backend> make_backend(const std::string& name, const BackendOptions& options = {});

/// The names that make_backend() accepts.
[[nodiscard]] std::vector<std::string> backend_names();

/// Why a backend cannot run here; empty if it can.
[[nodiscard]] std::string why_unavailable(const std::string& name);

/// The instruction sets that this build has CPU kernels for and this processor can run, from the least to the most
/// capable: names for BackendOptions::instruction_set.
[[nodiscard]] std::vector<std::string> cpu_instruction_sets();

}  // namespace tandem
