#include "backend_source.h"

#include <fmt/format.h>

#include <algorithm>

namespace tandem::bench {

std::vector<std::string> available_backends(const BackendSource& source, const std::vector<std::string>& names,
                                            Report& report) {
    std::vector<std::string> available;
    for (const std::string& name : names) {
        const std::string reason = source.why_unavailable(name);
        if (reason.empty()) {
            available.push_back(name);
        } else {
            report.blocks.emplace_back(Callout{Callout::Kind::note, fmt::format("Without {}: {}.", name, reason)});
        }
    }
    return available;
}

void describe_backend(const Backend& backend, Report& report) {
    const Capabilities capabilities = backend.capabilities();
    const std::pair<std::string, std::string> fact = {
        "Backend " + backend.name(), fmt::format("{}; {}", capabilities.device, capabilities.description)};
    auto& more = report.machine.more;
    if (std::find(more.begin(), more.end(), fact) == more.end()) more.push_back(fact);
}

}  // namespace tandem::bench
