#include "tandem/report/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tandem/report/format_number.h"
#include "tandem/report/html_text.h"
#include "tandem/report/plot_axis.h"

namespace tandem {

namespace {

constexpr double width = 860;
constexpr int colours = 6;                ///< classes c0 to c5 of the page
constexpr std::size_t most_marked = 200;  ///< longer lines get no dots with tooltips
constexpr double letter = 7;              ///< approximate width of a letter, pixels
constexpr double line_plot_height = 260;  ///< of the area inside the axes
constexpr double line_plot_left = 70;     ///< room for tick labels and the axis' name
constexpr double legend_line = 20;
constexpr double bar_pitch = 34;

double letters(const std::string& text) {
    // Bytes that begin a UTF-8 character.
    return static_cast<double>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string text_element(double x, double y, const char* classes, const std::string& text) {
    return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" class="{}">{}</text>)", x, y, classes, escape_html(text));
}

std::string line_element(double x1, double y1, double x2, double y2, const char* classes) {
    return fmt::format(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" class="{}"/>)", x1, y1, x2, y2,
                       classes);
}

std::string svg_element(double height, const std::string& title, const std::string& content) {
    return fmt::format(R"(<svg viewBox="0 0 {} {:.0f}" role="img" aria-label="{}">)"
                       "{}</svg>\n",
                       width, height, escape_html(title), content);
}

/// Adds legend lines from the top; returns their height.
double draw_legend(const LinePlot& plot, std::string& svg) {
    double x = line_plot_left;
    double y = legend_line;
    int colour = 0;
    for (const Line& line : plot.lines) {
        const double needed = 34 + letter * letters(line.label);
        if (x + needed > width && x > line_plot_left) {
            x = line_plot_left;
            y += legend_line;
        }
        svg += line_element(x, y - 5, x + 18, y - 5, fmt::format("line c{}", colour++ % colours).c_str());
        svg += text_element(x + 24, y, "start", line.label);
        x += needed;
    }
    return y + 12;
}

void draw_line(const Line& line, int colour, const AxisScale& x, const AxisScale& y, double top, std::string& svg) {
    std::string path;
    std::string dots;
    for (const Point& point : line.points) {
        if (!std::isfinite(point.x) || !std::isfinite(point.y)) continue;
        const double px = line_plot_left + x.position(point.x);
        const double py = top + line_plot_height - y.position(point.y);
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
    for (const Line& line : plot.lines) {
        for (const Point& point : line.points) {
            xs.push_back(point.x);
            ys.push_back(point.y);
        }
    }
    for (const ReferenceValue& reference : plot.references) ys.push_back(reference.value);
    const double plot_width = width - line_plot_left - 16;
    const AxisScale x(xs, plot.x.logarithmic, plot_width);
    const AxisScale y(ys, plot.y.logarithmic, line_plot_height);

    std::string svg;
    const double top = draw_legend(plot, svg);
    const double bottom = top + line_plot_height;
    for (const Tick& tick : y.ticks()) {
        const double at = bottom - y.position(tick.value);
        svg += line_element(line_plot_left, at, width - 16, at, "grid");
        svg += text_element(line_plot_left - 8, at + 4, "end small", tick.label);
    }
    for (const Tick& tick : x.ticks()) {
        const double at = line_plot_left + x.position(tick.value);
        svg += line_element(at, bottom, at, bottom + 5, "axis");
        svg += text_element(at, bottom + 20, "middle small", tick.label);
    }
    svg += line_element(line_plot_left, bottom, width - 16, bottom, "axis");
    svg += text_element(line_plot_left + plot_width / 2, bottom + 40, "middle small", plot.x.label);
    svg += fmt::format(R"svg(<text transform="translate(14 {:.1f}) rotate(-90)" class="middle small">{}</text>)svg",
                       top + line_plot_height / 2, escape_html(plot.y.label));
    for (const ReferenceValue& reference : plot.references) {
        const double at = bottom - y.position(reference.value);
        svg += line_element(line_plot_left, at, width - 16, at, "reference");
        svg += text_element(width - 20, at - 5, "end small muted", reference.label);
    }
    for (std::size_t i = 0; i < plot.lines.size(); ++i) {
        draw_line(plot.lines[i], static_cast<int>(i), x, y, top, svg);
    }
    return svg_element(bottom + 48, plot.title, svg);
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
