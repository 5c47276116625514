/// Plots as SVG elements inside a page, whose colours they use (the classes of html_writer.cpp).
#pragma once

#include <string>

#include "tandem/report/plot.h"

namespace tandem {

/// One <svg> element; all text is escaped.
[[nodiscard]] std::string to_svg(const LinePlot& plot);
[[nodiscard]] std::string to_svg(const BarPlot& plot);
[[nodiscard]] std::string to_svg(const ScatterPlot& plot);

}  // namespace tandem
