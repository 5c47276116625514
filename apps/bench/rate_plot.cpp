#include "rate_plot.h"

#include "tandem/report/format_number.h"

namespace tandem::bench {

BarPlot rate_plot(const std::string& title, const std::string& unit, std::span<const BenchmarkRow* const> rows,
                  double (*rate)(const BenchmarkRow&)) {
    BarPlot plot{title + "; whiskers from the slowest to the fastest measurement", {unit, true}, {}, {}};
    for (const BenchmarkRow* row : rows) {
        if (row->seconds.empty()) continue;
        const double value = rate(*row);
        const Summary time = summarize(row->seconds);
        const Interval range = {value * time.median / time.most, value * time.median / time.least};
        plot.bars.push_back({row->label, value, range, format_count(value)});
    }
    return plot;
}

}  // namespace tandem::bench
