/// A report as one HTML page.
#pragma once

#include <string>

#include "tandem/report/report.h"

namespace tandem {

/// A self-contained page: plots are SVG, images are data: URIs, styles are inline. It contains a script only if it
/// compares pictures. It is light or dark like the reader's system. All text is escaped. The machine and all rows are
/// at the end.
[[nodiscard]] std::string to_html(const Report& report);

}  // namespace tandem
