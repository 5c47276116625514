/// The backends of this build.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tandem/render/backend.h"

namespace tandem {

struct BackendEntry {
    const char* name;
    std::string (*why_unavailable)();  ///< empty if it can run on this machine
    std::unique_ptr<Backend> (*make)(const BackendOptions& options);
    std::vector<std::string> (*gpu_names)();  ///< of those that it can use; null if it uses none
};

/// cpu, cuda, oracle. A backend that was not built is listed too; its why_unavailable() says so.
[[nodiscard]] std::span<const BackendEntry> backend_registry();

}  // namespace tandem
