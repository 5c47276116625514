/// Plots as data; svg_plot.h renders them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tandem/report/statistics.h"

namespace tandem {

/// A logarithmic axis shows values that are not positive at its lower end, labelled 0.
struct Axis {
    std::string label;  ///< with the unit
    bool logarithmic = false;
};

struct Point {
    double x = 0;
    double y = 0;
};

struct Line {
    std::string label;
    std::vector<Point> points;
};

/// A value to compare with, drawn across the plot: "the paper: 35.3 s".
struct ReferenceValue {
    std::string label;
    double value = 0;
};

struct LinePlot {
    std::string title;
    Axis x;
    Axis y;
    std::vector<Line> lines;
    std::vector<ReferenceValue> references;
};

struct Bar {
    std::string label;
    double value = 0;
    std::optional<Interval> interval;
    std::string text;  ///< written at the bar
};

/// Horizontal bars, the first on top.
struct BarPlot {
    std::string title;
    Axis value;
    std::vector<Bar> bars;
    std::vector<ReferenceValue> references;
};

}  // namespace tandem
