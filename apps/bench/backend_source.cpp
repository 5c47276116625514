#include "backend_source.h"

#include <fmt/format.h>

#include <algorithm>

namespace tandem::bench {

std::string gpus_in_words(int count) { return fmt::format("{} GPU{}", count, count == 1 ? "" : "s"); }

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
    const std::size_t members = capabilities.members.size();
    const std::string together = members == 0 ? "" : fmt::format(", {} member{}", members, members == 1 ? "" : "s");
    const std::pair<std::string, std::string> fact = {
        "Backend " + backend.name() + together, fmt::format("{}; {}", capabilities.device, capabilities.description)};
    auto& more = report.machine.more;
    if (std::find(more.begin(), more.end(), fact) == more.end()) more.push_back(fact);
}

}  // namespace tandem::bench
