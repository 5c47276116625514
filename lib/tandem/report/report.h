/// A report as a list of blocks: written once, shown as text, JSON, CSV and a page.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tandem/report/machine.h"
#include "tandem/report/plot.h"
#include "tandem/report/row.h"

namespace tandem {

struct Heading {
    std::string text;
};

struct Paragraph {
    std::string text;
};

/// A command line, as typed.
struct Command {
    std::string text;
};

/// A highlighted sentence.
struct Callout {
    enum class Kind { good, bad, note };
    Kind kind = Kind::note;
    std::string text;
};

struct Table {
    struct Column {
        std::string name;
        bool numeric = false;  ///< aligned to the right
    };
    std::string caption;
    std::vector<Column> columns;
    std::vector<std::vector<std::string>> rows;
};

/// A picture as the bytes of a PNG file.
struct Picture {
    std::string caption;
    std::string png;
};

struct PictureGrid {
    std::vector<Picture> pictures;
};

/// A picture, and a map of where it errs.
struct ComparedPicture {
    Picture picture;
    Picture error_map;
};

/// Pictures of one size, two of them on top of each other with a divider to move, a zoom and the maps of their errors.
/// Without scripts the page shows all of them.
struct PictureComparison {
    std::string title;
    std::vector<ComparedPicture> pictures;
};

using Block = std::variant<Heading, Paragraph, Command, Callout, Table, LinePlot, BarPlot, ScatterPlot, PictureGrid,
                           PictureComparison>;

struct Report {
    std::string title;
    std::string summary;  ///< what the page shows, in one or two sentences
    std::string command;  ///< the command line that made it
    Machine machine;
    std::vector<Block> blocks;
    std::vector<BenchmarkRow> rows;  ///< every measurement, for machines and for checking
    RenderCounters counters;         ///< of everything rendered and traced outside the rows
    /// Values that are not times: hashes, verdicts, thread counts. Name and value, for the JSON file.
    std::vector<std::pair<std::string, std::string>> properties;
};

/// The counters of events that should not happen (render/counters.def): a sentence for every row that counted any, and
/// for the work outside the rows, or one sentence that there were none. Empty for a report without measurements. Every
/// writer shows them.
[[nodiscard]] std::vector<Callout> counter_callouts(const Report& report);

}  // namespace tandem
