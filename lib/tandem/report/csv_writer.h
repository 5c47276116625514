/// The rows of a report as CSV.
#pragma once

#include <span>
#include <string>

#include "tandem/report/row.h"

namespace tandem {

/// A header line and one line per row, seconds as medians; phases have a column each, named "phase_seconds",
/// and two for its interval; figures have a column each under their names. Quoted as in RFC 4180.
[[nodiscard]] std::string to_csv(std::span<const BenchmarkRow> rows);

}  // namespace tandem
