#include "tandem/report/text_writer.h"

#include <algorithm>
#include <sstream>

namespace tandem {

namespace {

constexpr std::size_t line_width = 118;

/// The width on a terminal: all characters that we use are one column wide.
std::size_t columns_of(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string wrapped(const std::string& text) {
    std::istringstream words(text);
    std::string word, result;
    std::size_t column = 0;
    while (words >> word) {
        const std::size_t width = columns_of(word);
        if (column != 0 && column + 1 + width > line_width) {
            result += '\n';
            column = 0;
        }
        if (column != 0) {
            result += ' ';
            ++column;
        }
        result += word;
        column += width;
    }
    return result + "\n";
}

struct TextBlocks {
    std::string& text;

    void operator()(const Heading& heading) const {
        text += "\n" + heading.text + "\n" + std::string(columns_of(heading.text), '-') + "\n";
    }
    void operator()(const Paragraph& paragraph) const { text += wrapped(paragraph.text); }
    void operator()(const Command& command) const { text += "    " + command.text + "\n"; }
    void operator()(const Callout& callout) const {
        const char* mark = callout.kind == Callout::Kind::good  ? "ok: "
                           : callout.kind == Callout::Kind::bad ? "NOT OK: "
                                                                : "note: ";
        text += wrapped(mark + callout.text);
    }
    void operator()(const Table& table) const {
        std::vector<std::size_t> widths;
        for (const Table::Column& column : table.columns) widths.push_back(columns_of(column.name));
        for (const auto& row : table.rows) {
            for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], columns_of(row[i]));
        }
        text += "\n";
        if (!table.caption.empty()) text += wrapped(table.caption);
        const auto line = [&](auto cell) {
            std::string result;
            for (std::size_t i = 0; i < widths.size(); ++i) {
                const std::string content = cell(i);
                const std::string space(widths[i] - columns_of(content), ' ');
                if (i != 0) result += "  ";
                result += table.columns[i].numeric ? space + content : content + space;
            }
            text += result.substr(0, result.find_last_not_of(' ') + 1) + "\n";
        };
        line([&](std::size_t i) { return table.columns[i].name; });
        line([&](std::size_t i) { return std::string(widths[i], '-'); });
        for (const auto& row : table.rows) line([&](std::size_t i) { return row[i]; });
        text += "\n";
    }
    void operator()(const LinePlot&) const {}
    void operator()(const BarPlot&) const {}
    void operator()(const ScatterPlot&) const {}
    void operator()(const PictureGrid&) const {}
    void operator()(const PictureComparison&) const {}
};

}  // namespace

std::string to_text(const Report& report) {
    std::string text = report.title + "\n" + std::string(columns_of(report.title), '=') + "\n";
    text += wrapped(report.summary);
    for (const Block& block : report.blocks) std::visit(TextBlocks{text}, block);
    for (const Callout& callout : counter_callouts(report)) TextBlocks{text}(callout);
    return text;
}

}  // namespace tandem
