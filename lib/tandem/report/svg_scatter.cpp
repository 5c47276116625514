#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tandem/report/format_number.h"
#include "tandem/report/html_text.h"
#include "tandem/report/plot_axis.h"
#include "tandem/report/svg_parts.h"
#include "tandem/report/svg_plot.h"

namespace tandem {

using namespace svg;

namespace {

constexpr double plot_height = 400;
constexpr double failure_room = 16;  ///< above the axes, for failed points

/// Paths around the origin, about 9 pixels wide: circle, square, triangle, diamond, plus, triangle upside down,
/// hourglass, bar, ring.
constexpr std::array shape_paths = {
    "M-4.5 0A4.5 4.5 0 1 0 4.5 0A4.5 4.5 0 1 0 -4.5 0Z",
    "M-4 -4H4V4H-4Z",
    "M0 -5L4.8 3.6H-4.8Z",
    "M0 -5.5L5.5 0L0 5.5L-5.5 0Z",
    "M-1.6 -5H1.6V-1.6H5V1.6H1.6V5H-1.6V1.6H-5V-1.6H-1.6Z",
    "M-4.8 -3.6H4.8L0 5Z",
    "M-4.5 -4.5H4.5L-4.5 4.5H4.5Z",
    "M-5.5 -2H5.5V2H-5.5Z",
    "M-5 0A5 5 0 1 0 5 0A5 5 0 1 0 -5 0ZM-2.5 0A2.5 2.5 0 1 1 2.5 0A2.5 2.5 0 1 1 -2.5 0Z"};
constexpr const char* cross = "M-5 -3.5L-3.5 -5L0 -1.5L3.5 -5L5 -3.5L1.5 0L5 3.5L3.5 5L0 1.5L-3.5 5L-5 3.5L-1.5 0Z";

std::string shape_element(double x, double y, const char* path, const std::string& title) {
    const std::string tip = title.empty() ? "" : "<title>" + escape_html(title) + "</title>";
    return fmt::format(R"svg(<path transform="translate({:.1f} {:.1f})" d="{}">{}</path>)svg", x, y, path, tip);
}

std::string series_symbol(double x, double y, int index) {
    return fmt::format(R"(<g class="dots c{}"><rect x="{:.1f}" y="{:.1f}" width="18" height="8"/></g>)",
                       index % colours, x, y - 4);
}

std::string shape_symbol(double x, double y, int index) {
    return "<g class=\"dots faded\">" +
           shape_element(x + 9, y, shape_paths[static_cast<std::size_t>(index) % shape_paths.size()], "") + "</g>";
}

std::string cross_symbol(double x, double y, int) {
    return "<g class=\"dots failed\">" + shape_element(x + 9, y, cross, "") + "</g>";
}

std::vector<LegendEntry> legend_of(const ScatterPlot& plot) {
    std::vector<LegendEntry> legend;
    int index = 0;
    bool failed = false;
    for (const ScatterSeries& series : plot.series) {
        legend.push_back({series.label, series_symbol, index++});
        failed =
            failed || std::any_of(series.points.begin(), series.points.end(), [](const auto& p) { return p.failed; });
    }
    index = 0;
    for (const std::string& shape : plot.shapes) {
        const auto has_it = [&](const ScatterPoint& point) { return point.shape == static_cast<std::size_t>(index); };
        const bool used = std::any_of(plot.series.begin(), plot.series.end(), [&](const ScatterSeries& series) {
            return std::any_of(series.points.begin(), series.points.end(), has_it);
        });
        if (used) legend.push_back({shape, shape_symbol, index});
        ++index;
    }
    if (failed) legend.push_back({"failed", cross_symbol, 0});
    return legend;
}

/// Draws points in an area.
struct ScatterArea {
    const Area& area;
    const AxisScale& x;
    const AxisScale& y;

    [[nodiscard]] double across(double value) const { return area.left + x.position(value); }
    [[nodiscard]] double down(double value) const { return area.bottom() - y.position(value); }

    [[nodiscard]] std::string box(const ScatterPoint& point) const {
        const double left = across(point.x.low), right = across(point.x.high);
        const double top = down(point.y.high), bottom = down(point.y.low);
        return fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" class="box"/>)", left, top,
                           std::max(right - left, 1.0), std::max(bottom - top, 1.0));
    }
    [[nodiscard]] std::string drawn(const ScatterPoint& point) const {
        if (point.failed) return shape_element(across(point.at.x), area.top - failure_room / 2, cross, point.label);
        const double px = across(point.at.x), py = down(point.at.y);
        std::string svg =
            box(point) + shape_element(px, py, shape_paths[point.shape % shape_paths.size()], point.label);
        if (!point.mark.empty()) svg += text_element(px + 7, py - 5, "start small mark", point.mark);
        return svg;
    }
    /// Through the points of the front, from left to right.
    [[nodiscard]] std::string front(const ScatterSeries& series, int colour) const {
        std::vector<Point> points;
        for (const ScatterPoint& point : series.points) {
            if (!point.faded && !point.failed && std::isfinite(point.at.y)) points.push_back(point.at);
        }
        std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.x < b.x; });
        std::string path;
        for (const Point& point : points) {
            path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", across(point.x), down(point.y));
        }
        return fmt::format(R"(<path d="{}" class="line front c{}"/>)", path, colour % colours);
    }
};

}  // namespace

std::string to_svg(const ScatterPlot& plot) {
    std::vector<double> xs, ys;
    for (const ScatterSeries& series : plot.series) {
        for (const ScatterPoint& point : series.points) {
            xs.insert(xs.end(), {point.at.x, point.x.low, point.x.high});
            if (point.failed) continue;
            ys.insert(ys.end(), {point.at.y, point.y.low, point.y.high});
        }
    }
    for (const ReferenceValue& reference : plot.references) ys.push_back(reference.value);
    std::string svg;
    Area area;
    area.top = draw_legend(legend_of(plot), svg) + failure_room;
    area.height = plot_height;
    const AxisScale x(xs, plot.x.logarithmic, area.right() - area.left);
    const AxisScale y(ys, plot.y.logarithmic, area.height);
    draw_axes(area, plot.x, x, plot.y, y, plot.references, svg);
    const ScatterArea points{area, x, y};
    std::string faded, failed, fronts;
    int colour = 0;
    for (const ScatterSeries& series : plot.series) {
        fronts += points.front(series, colour);
        std::string clear;
        for (const ScatterPoint& point : series.points) {
            (point.failed ? failed : point.faded ? faded : clear) += points.drawn(point);
        }
        fronts += fmt::format(R"(<g class="dots c{}">{}</g>)", colour++ % colours, clear);
    }
    // Dominated points lie behind the rest
    svg += "<g class=\"dots faded\">" + faded + "</g>" + fronts + "<g class=\"dots failed\">" + failed + "</g>";
    return svg_element(area.bottom() + 48, plot.title, svg);
}

}  // namespace tandem
