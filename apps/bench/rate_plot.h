/// Bars of samples or rays per second.
#pragma once

#include <span>
#include <string>

#include "tandem/report/plot.h"
#include "tandem/report/row.h"

namespace tandem::bench {

/// One bar per row that was measured, by its median time; whiskers from its slowest to its fastest measurement.
/// `rate` is samples_per_second or rays_per_second.
[[nodiscard]] BarPlot rate_plot(const std::string& title, const std::string& unit,
                                std::span<const BenchmarkRow* const> rows, double (*rate)(const BenchmarkRow&));

}  // namespace tandem::bench
