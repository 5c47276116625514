/// A report as plain text.
#pragma once

#include <string>

#include "tandem/report/report.h"

namespace tandem {

/// Headings, paragraphs, callouts and tables as plain text, for a terminal; plots and images are only on the page.
[[nodiscard]] std::string to_text(const Report& report);

}  // namespace tandem
