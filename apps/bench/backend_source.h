/// Where benchmarks get their backends; tests replace it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tandem/backends/make_backend.h"
#include "tandem/report/report.h"

namespace tandem::bench {

struct BackendSource {
    std::function<std::string(const std::string& name)> why_unavailable = tandem::why_unavailable;
    std::function<std::unique_ptr<Backend>(const std::string& name, const BackendOptions& options)> make =
        tandem::make_backend;
    std::function<int()> gpu_count = [] { return static_cast<int>(gpu_names().size()); };
};

/// "1 GPU", "2 GPUs".
[[nodiscard]] std::string gpus_in_words(int count);

/// The backends among `names` that can run here. A note in `report` names each of the others, with the reason.
[[nodiscard]] std::vector<std::string> available_backends(const BackendSource& source,
                                                          const std::vector<std::string>& names, Report& report);

/// Adds the backend's device and libraries to the machine of the report, once.
void describe_backend(const Backend& backend, Report& report);

}  // namespace tandem::bench
