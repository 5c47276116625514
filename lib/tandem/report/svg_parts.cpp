#include "tandem/report/svg_parts.h"

#include <fmt/format.h>

#include <algorithm>

#include "tandem/report/html_text.h"

namespace tandem::svg {

namespace {

constexpr double legend_line = 20;
constexpr double legend_left = 70;

}  // namespace

double letters(const std::string& text) {
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

double draw_legend(const std::vector<LegendEntry>& entries, std::string& svg) {
    double x = legend_left;
    double y = legend_line;
    for (const LegendEntry& entry : entries) {
        const double needed = 34 + letter * letters(entry.label);
        if (x + needed > width && x > legend_left) {
            x = legend_left;
            y += legend_line;
        }
        svg += entry.symbol(x, y - 5, entry.index);
        svg += text_element(x + 24, y, "start", entry.label);
        x += needed;
    }
    return y + 12;
}

void draw_axes(const Area& area, const Axis& x_axis, const AxisScale& x, const Axis& y_axis, const AxisScale& y,
               const std::vector<ReferenceValue>& references, std::string& svg) {
    const double bottom = area.bottom();
    for (const Tick& tick : y.ticks()) {
        const double at = bottom - y.position(tick.value);
        svg += line_element(area.left, at, area.right(), at, "grid");
        svg += text_element(area.left - 8, at + 4, "end small", tick.label);
    }
    for (const Tick& tick : x.ticks()) {
        const double at = area.left + x.position(tick.value);
        svg += line_element(at, bottom, at, bottom + 5, "axis");
        svg += text_element(at, bottom + 20, "middle small", tick.label);
    }
    svg += line_element(area.left, bottom, area.right(), bottom, "axis");
    svg += text_element((area.left + area.right()) / 2, bottom + 40, "middle small", x_axis.label);
    svg += fmt::format(R"svg(<text transform="translate(14 {:.1f}) rotate(-90)" class="middle small">{}</text>)svg",
                       area.top + area.height / 2, escape_html(y_axis.label));
    for (const ReferenceValue& reference : references) {
        const double at = bottom - y.position(reference.value);
        svg += line_element(area.left, at, area.right(), at, "reference");
        svg += text_element(area.right() - 4, at - 5, "end small muted", reference.label);
    }
}

}  // namespace tandem::svg
