/// Backends by name.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tandem/render/backend.h"

namespace tandem {

/// Makes "cpu", "cuda" or "oracle". "cuda:1" is GPU 1, "cuda:0,1" are two GPUs as one backend, "cuda:all" all of them;
/// "cuda" uses those of `options`. Throws InputError for another name, and EnvironmentError, with the reason, for a
/// backend that this build or this machine cannot run.
[[nodiscard]] std::unique_ptr<Backend> make_backend(const std::string& name, const BackendOptions& options = {});

/// The names that make_backend() accepts.
[[nodiscard]] std::vector<std::string> backend_names();

/// The models of the GPUs that "cuda" can use, by their numbers; empty if it cannot run.
[[nodiscard]] std::vector<std::string> gpu_names();

/// Why a backend cannot run here; empty if it can. The name may have GPUs, as for make_backend().
[[nodiscard]] std::string why_unavailable(const std::string& name);

/// The instruction sets that this build has CPU kernels for and this processor can run, from the least to the most
/// capable: names for BackendOptions::instruction_set.
[[nodiscard]] std::vector<std::string> cpu_instruction_sets();

}  // namespace tandem
