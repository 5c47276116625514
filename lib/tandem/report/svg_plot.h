/// Plots as SVG elements that stand inside a page and take its colours (the classes of html_writer.cpp).
#pragma once

#include <string>

#include "tandem/report/plot.h"

namespace tandem {

/// One <svg> element; all text is escaped.
[[nodiscard]] std::string to_svg(const LinePlot& plot);
[[nodiscard]] std::string to_svg(const BarPlot& plot);

}  // namespace tandem
