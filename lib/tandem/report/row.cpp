#include "tandem/report/row.h"

#include <algorithm>

namespace tandem {

namespace {

double per_second(double amount, const BenchmarkRow& row) {
    return row.seconds.empty() ? 0 : amount / median(row.seconds);
}

}  // namespace

double samples_per_second(const BenchmarkRow& row) { return per_second(row.samples, row); }
double rays_per_second(const BenchmarkRow& row) { return per_second(row.rays, row); }

std::optional<Factor> factor_over(const BenchmarkRow& baseline, const BenchmarkRow& row) {
    std::vector<double> theirs, ours;
    for (std::size_t i = 0; i < row.rounds.size(); ++i) {
        const auto same = std::find(baseline.rounds.begin(), baseline.rounds.end(), row.rounds[i]);
        if (same == baseline.rounds.end()) continue;
        theirs.push_back(baseline.seconds[static_cast<std::size_t>(same - baseline.rounds.begin())]);
        ours.push_back(row.seconds[i]);
    }
    if (ours.empty()) return std::nullopt;
    return Factor{baseline.label, ratio_of_medians(theirs, ours)};
}

PhaseTimings& phase(BenchmarkRow& row, const std::string& name) {
    for (PhaseTimings& timings : row.phases) {
        if (timings.name == name) return timings;
    }
    return row.phases.emplace_back(PhaseTimings{name, {}});
}

}  // namespace tandem
