#include "tandem/report/html_writer.h"

#include <fmt/format.h>

#include "tandem/report/format_number.h"
#include "tandem/report/html_text.h"
#include "tandem/report/svg_plot.h"
#include "tandem_comparison_js.h"
#include "tandem_page_html.h"

namespace tandem {

namespace {

std::string html_of(const Table& table) {
    std::string html = "<div class=\"scroll\"><table>";
    if (!table.caption.empty()) html += "<caption>" + escape_html(table.caption) + "</caption>";
    const auto cell = [&](const char* tag, std::size_t column, const std::string& text) {
        html += fmt::format("<{}{}>{}</{}>", tag, table.columns[column].numeric ? " class=\"number\"" : "",
                            escape_html(text), tag);
    };
    html += "<thead><tr>";
    for (std::size_t i = 0; i < table.columns.size(); ++i) cell("th", i, table.columns[i].name);
    html += "</tr></thead><tbody>";
    for (const auto& row : table.rows) {
        html += "<tr>";
        for (std::size_t i = 0; i < row.size(); ++i) cell("td", i, row[i]);
        html += "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

template <class Plot>
std::string figure_of(const Plot& plot) {
    return "<figure><figcaption class=\"title\">" + escape_html(plot.title) + "</figcaption>" + to_svg(plot) +
           "</figure>\n";
}

std::string html_of(const Callout& callout) {
    switch (callout.kind) {
        case Callout::Kind::good:
            return "<p class=\"callout good\"><b>OK</b>" + escape_html(callout.text) + "</p>\n";
        case Callout::Kind::bad:
            return "<p class=\"callout bad\"><b>Not OK</b>" + escape_html(callout.text) + "</p>\n";
        case Callout::Kind::note:
            break;
    }
    return "<p class=\"callout note\"><b>Note</b>" + escape_html(callout.text) + "</p>\n";
}

std::string figure_of_picture(const Picture& picture) {
    const std::string caption = escape_html(picture.caption);
    return fmt::format(
        "<figure><img alt=\"{}\" src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption></figure>\n", caption,
        base64(picture.png), caption);
}

std::string html_of(const PictureGrid& grid) {
    std::string html = "<div class=\"pictures\">";
    for (const Picture& picture : grid.pictures) html += figure_of_picture(picture);
    return html + "</div>\n";
}

/// Pairs of picture and map, from which comparison.js makes the comparison.
std::string html_of(const PictureComparison& comparison) {
    std::string html = "<figure class=\"compare\"><figcaption class=\"title\">" + escape_html(comparison.title) +
                       "</figcaption><div class=\"pictures\">";
    for (const ComparedPicture& pair : comparison.pictures) {
        html += figure_of_picture(pair.picture) + figure_of_picture(pair.error_map);
    }
    return html + "</div></figure>\n";
}

std::string html_of(const Heading& heading) { return "<h2>" + escape_html(heading.text) + "</h2>\n"; }
std::string html_of(const Paragraph& paragraph) { return "<p>" + escape_html(paragraph.text) + "</p>\n"; }
std::string html_of(const Command& command) { return "<pre>" + escape_html(command.text) + "</pre>\n"; }
std::string html_of(const LinePlot& plot) { return figure_of(plot); }
std::string html_of(const BarPlot& plot) { return figure_of(plot); }
std::string html_of(const ScatterPlot& plot) { return figure_of(plot); }

Table machine_table(const Machine& machine) {
    Table table{{}, {{"What"}, {"This machine"}}, {}};
    for (const auto& [name, value] : facts(machine)) table.rows.push_back({name, value});
    return table;
}

std::string phases_in_words(const BenchmarkRow& row) {
    std::string text;
    for (const PhaseTimings& timings : row.phases) {
        if (timings.seconds.empty()) continue;
        text += (text.empty() ? "" : ", ") + timings.name + " " + format_seconds(median(timings.seconds));
    }
    return text;
}

Table all_rows(const std::vector<BenchmarkRow>& rows) {
    Table table{{}, {{"Row"}, {"Scene"}, {"Code"}, {"Threads", true}, {"n", true}, {"Time", true}, {"Phases"}}, {}};
    for (const BenchmarkRow& row : rows) {
        const std::string code = row.variant.empty() ? row.backend : row.backend + ": " + row.variant;
        table.rows.push_back({row.label, row.scene, code, row.threads == 0 ? "" : fmt::format("{}", row.threads),
                              fmt::format("{}", row.seconds.size()), format_summary(summarize(row.seconds)),
                              phases_in_words(row)});
    }
    return table;
}

}  // namespace

std::string to_html(const Report& report) {
    std::string content;
    bool compares = false;
    for (const Block& block : report.blocks) {
        compares = compares || std::holds_alternative<PictureComparison>(block);
        content += std::visit([](const auto& one) { return html_of(one); }, block);
    }
    for (const Callout& callout : counter_callouts(report)) content += html_of(callout);
    return fill_template(page_template,
                         {{"title", escape_html(report.title)},
                          {"summary", escape_html(report.summary)},
                          {"command", escape_html(report.command)},
                          {"content", content},
                          {"machine", html_of(machine_table(report.machine))},
                          {"script", compares ? fmt::format("<script>\n{}</script>\n", comparison_script) : ""},
                          {"rows", html_of(all_rows(report.rows))}});
}

}  // namespace tandem
