/// A report for machines.
#pragma once

#include <string>

#include "tandem/report/report.h"

namespace tandem {

/// Pretty-printed JSON: title, command, machine, properties, rows (with every single measurement, in seconds),
/// tables, plots (as data) and callouts; pictures are left out. Numbers that are not finite become null. The keys are
/// described in docs/reading-results.md.
[[nodiscard]] std::string to_json(const Report& report);

}  // namespace tandem
