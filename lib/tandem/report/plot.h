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

/// A point with the intervals of both coordinates, drawn as a box around it.
struct ScatterPoint {
    Point at;
    Interval x;
    Interval y;
    std::string label;      ///< shown when the mouse is over it
    std::string mark;       ///< a short text beside it; may be empty
    std::size_t shape = 0;  ///< of ScatterPlot::shapes
    bool faded = false;     ///< grey, and not on the line of its series
    bool failed = false;    ///< a cross at the upper end, since its y says nothing
};

struct ScatterSeries {
    std::string label;
    std::vector<ScatterPoint> points;
};

/// Points in the colours of their series, with a line through those that are neither faded nor failed.
struct ScatterPlot {
    std::string title;
    Axis x;
    Axis y;
    std::vector<std::string> shapes;  ///< what a shape means; up to nine
    std::vector<ScatterSeries> series;
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
