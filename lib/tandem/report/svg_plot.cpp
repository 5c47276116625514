#include "tandem/report/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tandem/report/format_number.h"
#include "tandem/report/html_text.h"
#include "tandem/report/plot_axis.h"
#include "tandem/report/svg_parts.h"

namespace tandem {

using namespace svg;

namespace {

constexpr std::size_t most_marked = 200;  ///< longer lines get no dots with tooltips
constexpr double bar_pitch = 34;

std::string line_symbol(double x, double y, int index) {
    return line_element(x, y, x + 18, y, fmt::format("line c{}", index % colours).c_str());
}

void draw_line(const Line& line, int colour, const Area& area, const AxisScale& x, const AxisScale& y,
               std::string& svg) {
    std::string path;
    std::string dots;
    for (const Point& point : line.points) {
        if (!std::isfinite(point.x) || !std::isfinite(point.y)) continue;
        const double px = area.left + x.position(point.x);
        const double py = area.bottom() - y.position(point.y);
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", px, py);
        if (line.points.size() <= most_marked) {
            dots += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="2.2"><title>{}: {}, {}</title></circle>)", px, py,
                                escape_html(line.label), format_number(point.x), format_number(point.y));
        }
    }
    svg += fmt::format(R"(<path d="{}" class="line c{}"/><g class="dots c{}">{}</g>)", path, colour % colours,
                       colour % colours, dots);
}

}  // namespace

std::string to_svg(const LinePlot& plot) {
    std::vector<double> xs, ys;
    std::vector<LegendEntry> legend;
    for (const Line& line : plot.lines) {
        legend.push_back({line.label, line_symbol, static_cast<int>(legend.size())});
        for (const Point& point : line.points) {
            xs.push_back(point.x);
            ys.push_back(point.y);
        }
    }
    for (const ReferenceValue& reference : plot.references) ys.push_back(reference.value);
    std::string svg;
    Area area;
    area.top = draw_legend(legend, svg);
    const AxisScale x(xs, plot.x.logarithmic, area.right() - area.left);
    const AxisScale y(ys, plot.y.logarithmic, area.height);
    draw_axes(area, plot.x, x, plot.y, y, plot.references, svg);
    for (std::size_t i = 0; i < plot.lines.size(); ++i) {
        draw_line(plot.lines[i], static_cast<int>(i), area, x, y, svg);
    }
    return svg_element(area.bottom() + 48, plot.title, svg);
}

std::string to_svg(const BarPlot& plot) {
    std::vector<double> values;
    double label_room = 0;
    double text_room = 0;
    for (const Bar& bar : plot.bars) {
        values.push_back(bar.value);
        if (bar.interval) values.insert(values.end(), {bar.interval->low, bar.interval->high});
        label_room = std::max(label_room, letter * letters(bar.label));
        text_room = std::max(text_room, letter * letters(bar.text));
    }
    for (const ReferenceValue& reference : plot.references) values.push_back(reference.value);
    // On a logarithmic axis the shortest bar needs a length too.
    if (plot.value.logarithmic && !values.empty())
        values.push_back(*std::min_element(values.begin(), values.end()) / 2);
    const double left = std::min(label_room + 16, width / 2);
    const double plot_width = std::max(width - left - text_room - 24, 120.0);
    const AxisScale scale(values, plot.value.logarithmic, plot_width);
    const double top = plot.references.empty() ? 8 : 26;
    const double bottom = top + bar_pitch * static_cast<double>(plot.bars.size());

    std::string svg;
    for (const Tick& tick : scale.ticks()) {
        const double at = left + scale.position(tick.value);
        svg += line_element(at, top, at, bottom, "grid");
        svg += text_element(at, bottom + 18, "middle small", tick.label);
    }
    for (std::size_t i = 0; i < plot.bars.size(); ++i) {
        const Bar& bar = plot.bars[i];
        const double y = top + bar_pitch * static_cast<double>(i) + 6;
        const double middle = y + (bar_pitch - 12) / 2;
        const double length = scale.position(bar.value);
        svg += fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" rx="2" class="bar"/>)", left,
                           y, std::max(length, 1.0), bar_pitch - 12);
        double end = left + length;
        if (bar.interval) {
            const double low = left + scale.position(bar.interval->low);
            const double high = left + scale.position(bar.interval->high);
            svg += line_element(low, middle, high, middle, "whisker");
            svg += line_element(low, middle - 5, low, middle + 5, "whisker");
            svg += line_element(high, middle - 5, high, middle + 5, "whisker");
            end = std::max(end, high);
        }
        svg += text_element(left - 8, middle + 5, "end", bar.label);
        svg += text_element(end + 8, middle + 5, "start small", bar.text);
    }
    for (const ReferenceValue& reference : plot.references) {
        const double at = left + scale.position(reference.value);
        svg += line_element(at, top - 6, at, bottom, "reference");
        svg += text_element(at, top - 10, "middle small muted", reference.label);
    }
    svg += text_element(left + plot_width / 2, bottom + 38, "middle small", plot.value.label);
    return svg_element(bottom + 46, plot.title, svg);
}

}  // namespace tandem
