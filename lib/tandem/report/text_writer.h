/// A report for a terminal.
#pragma once

#include <string>

#include "tandem/report/report.h"

namespace tandem {

/// Headings, paragraphs, callouts and tables as plain text; plots and pictures are left to the page.
[[nodiscard]] std::string to_text(const Report& report);

}  // namespace tandem
