#include "tandem/report/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tandem {

std::vector<Callout> counter_callouts(const Report& report) {
    std::vector<Callout> callouts;
    const auto add = [&](const std::string& where, const RenderCounters& counters) {
        const std::vector<std::string> counted = in_words(counters);
        if (counted.empty()) return;
        callouts.push_back({Callout::Kind::bad, fmt::format("{}: {}.", where, fmt::join(counted, "; "))});
    };
    for (const BenchmarkRow& row : report.rows) add(fmt::format("{}, {}", row.label, row.scene), row.counters);
    add("Outside the rows", report.counters);
    if (callouts.empty() && !report.rows.empty()) {
        callouts.push_back({Callout::Kind::good,
                            "No sample was NaN or infinite, no ray was rejected, no traversal stack overflowed, no "
                            "primitive was dropped."});
    }
    return callouts;
}

}  // namespace tandem
