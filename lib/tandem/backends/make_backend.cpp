#include "tandem/backends/make_backend.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tandem/backends/registry.h"
#include "tandem/base/error.h"

namespace tandem {

std::vector<std::string> backend_names() {
    std::vector<std::string> names;
    for (const BackendEntry& entry : backend_registry()) names.emplace_back(entry.name);
    return names;
}

namespace {

const BackendEntry& find_entry(const std::string& name) {
    for (const BackendEntry& entry : backend_registry()) {
        if (name == entry.name) return entry;
    }
    throw InputError(
        fmt::format("there is no backend '{}'; the backends are {}", name, fmt::join(backend_names(), ", ")));
}

}  // namespace

std::string why_unavailable(const std::string& name) { return find_entry(name).why_unavailable(); }

std::unique_ptr<Backend> make_backend(const std::string& name, const BackendOptions& options) {
    const BackendEntry& entry = find_entry(name);
    const std::string reason = entry.why_unavailable();
    if (!reason.empty()) throw EnvironmentError(fmt::format("the backend '{}' cannot run here: {}", name, reason));
    return entry.make(options);
}

}  // namespace tandem
