/// Parts that all plots share, as SVG.
#pragma once

#include <string>
#include <vector>

#include "tandem/report/plot.h"
#include "tandem/report/plot_axis.h"

namespace tandem {

namespace svg {

inline constexpr double width = 860;
inline constexpr int colours = 6;    ///< classes c0 to c5 of the page
inline constexpr double letter = 7;  ///< approximate width of a letter, pixels

/// The number of characters: the bytes that begin one in UTF-8.
[[nodiscard]] double letters(const std::string& text);

[[nodiscard]] std::string text_element(double x, double y, const char* classes, const std::string& text);
[[nodiscard]] std::string line_element(double x1, double y1, double x2, double y2, const char* classes);
[[nodiscard]] std::string svg_element(double height, const std::string& title, const std::string& content);

/// The area inside the axes, in pixels of the plot.
struct Area {
    double left = 70;  ///< leaves room for tick labels and the axis' name
    double top = 0;
    double height = 260;

    [[nodiscard]] double right() const { return width - 16; }
    [[nodiscard]] double bottom() const { return top + height; }
};

/// An entry of a legend: a symbol 18 pixels wide, drawn from (x, y) to the right, and its label.
struct LegendEntry {
    std::string label;
    std::string (*symbol)(double x, double y, int index);
    int index = 0;
};

/// Adds lines of entries from the top of the plot; returns their height.
double draw_legend(const std::vector<LegendEntry>& entries, std::string& svg);

/// Adds grid, ticks, labels and reference values.
void draw_axes(const Area& area, const Axis& x_axis, const AxisScale& x, const Axis& y_axis, const AxisScale& y,
               const std::vector<ReferenceValue>& references, std::string& svg);

}  // namespace svg

}  // namespace tandem
