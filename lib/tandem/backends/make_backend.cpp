#include "tandem/backends/make_backend.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <string_view>

#include "tandem/backends/registry.h"
#include "tandem/base/error.h"

namespace tandem {

std::vector<std::string> backend_names() {
    std::vector<std::string> names;
    for (const BackendEntry& entry : backend_registry()) names.emplace_back(entry.name);
    return names;
}

namespace {

const BackendEntry& find_entry(std::string_view name) {
    for (const BackendEntry& entry : backend_registry()) {
        if (name == entry.name) return entry;
    }
    throw InputError(
        fmt::format("there is no backend '{}'; the backends are {}", name, fmt::join(backend_names(), ", ")));
}

/// A name in its two parts: "cuda:0,1".
struct NamedGpus {
    std::string backend;
    std::optional<GpuChoice> gpus;
};

NamedGpus split(const std::string& name) {
    constexpr std::string_view start = "cuda:";
    if (!name.starts_with(start)) return {name, std::nullopt};
    return {"cuda", parse_gpu_list(name.substr(start.size()))};
}

}  // namespace

std::vector<std::string> gpu_names() {
    const BackendEntry& entry = find_entry("cuda");
    return entry.why_unavailable().empty() ? entry.gpu_names() : std::vector<std::string>();
}

std::string why_unavailable(const std::string& name) { return find_entry(split(name).backend).why_unavailable(); }

std::unique_ptr<Backend> make_backend(const std::string& name, const BackendOptions& options) {
    const NamedGpus named = split(name);
    const BackendEntry& entry = find_entry(named.backend);
    if (options.gpus != GpuChoice{} && (named.gpus || entry.gpu_names == nullptr)) {
        throw InputError(named.gpus ? fmt::format("'{}' already names its GPUs; leave out the other choice", name)
                                    : fmt::format("GPUs are chosen for the backend cuda; '{}' has none", name));
    }
    const std::string reason = entry.why_unavailable();
    if (!reason.empty()) throw EnvironmentError(fmt::format("the backend '{}' cannot run here: {}", name, reason));
    if (!named.gpus) return entry.make(options);
    BackendOptions chosen = options;
    chosen.gpus = *named.gpus;
    return entry.make(chosen);
}

}  // namespace tandem
