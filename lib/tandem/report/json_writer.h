/// A report as JSON.
#pragma once

#include <string>

#include "tandem/report/report.h"

namespace tandem {

/// Pretty-printed JSON: title, command, machine, properties, rows (with every single measurement, in seconds),
/// tables, plots (as data) and callouts; images are left out. Numbers that are not finite become null.
/// docs/reading-results.md describes the keys.
[[nodiscard]] std::string to_json(const Report& report);

}  // namespace tandem
