/// A report as one page.
#pragma once

#include <string>

#include "tandem/report/report.h"

namespace tandem {

/// A page that needs nothing but itself: plots are SVG, pictures are data: URIs, styles stand in it, there is no
/// script. Light or dark as the reader's system is. All text is escaped. At the end stand the machine and all rows.
[[nodiscard]] std::string to_html(const Report& report);

}  // namespace tandem
