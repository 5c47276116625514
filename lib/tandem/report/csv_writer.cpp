#include "tandem/report/csv_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace tandem {

namespace {

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"') result += '"';
        result += c;
    }
    return result + '"';
}

void append_line(std::string& csv, const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (i != 0) csv += ',';
        csv += quoted(cells[i]);
    }
    csv += "\r\n";
}

std::vector<std::string> phase_names(std::span<const BenchmarkRow> rows) {
    std::vector<std::string> names;
    for (const BenchmarkRow& row : rows) {
        for (const PhaseTimings& timings : row.phases) {
            if (std::find(names.begin(), names.end(), timings.name) == names.end()) names.push_back(timings.name);
        }
    }
    return names;
}

std::vector<std::string> figure_names(std::span<const BenchmarkRow> rows) {
    std::vector<std::string> names;
    for (const BenchmarkRow& row : rows) {
        for (const auto& [name, value] : row.figures) {
            if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
        }
    }
    return names;
}

/// The median of a phase and the ends of its interval; empty where they are not known.
std::vector<std::string> phase_cells(const BenchmarkRow& row, const std::string& name) {
    for (const PhaseTimings& timings : row.phases) {
        if (timings.name != name || timings.seconds.empty()) continue;
        const Summary time = summarize(timings.seconds);
        std::vector<std::string> cells = {fmt::format("{}", time.median), "", ""};
        if (time.interval)
            cells = {cells[0], fmt::format("{}", time.interval->low), fmt::format("{}", time.interval->high)};
        return cells;
    }
    return {"", "", ""};
}

std::string figure_of(const BenchmarkRow& row, const std::string& name) {
    for (const auto& [figure, value] : row.figures) {
        if (figure == name) return fmt::format("{}", value);
    }
    return {};
}

}  // namespace

std::string to_csv(std::span<const BenchmarkRow> rows) {
    const std::vector<std::string> phases = phase_names(rows);
    const std::vector<std::string> figures = figure_names(rows);
    std::vector<std::string> header = {
        "label", "scene", "backend",       "variant",    "tier",   "threads",    "measurements", "seconds",    "mad",
        "min",   "max",   "samples_per_s", "rays_per_s", "factor", "factor_low", "factor_high",  "factor_over"};
    for (const std::string& name : phases) {
        for (const char* end : {"_seconds", "_seconds_low", "_seconds_high"}) header.push_back(name + end);
    }
#define TANDEM_COUNTER(name, words) header.push_back(#name);
#include "tandem/render/counters.def"
#undef TANDEM_COUNTER
    header.insert(header.end(), figures.begin(), figures.end());
    std::string csv;
    append_line(csv, header);
    for (const BenchmarkRow& row : rows) {
        const Summary time = summarize(row.seconds);
        std::vector<std::string> cells = {row.label, row.scene, row.backend, row.variant, row.tier};
        const auto number = [&](auto value) { cells.push_back(fmt::format("{}", value)); };
        number(row.threads);
        number(time.count);
        for (const double value : {time.median, time.deviation, time.least, time.most}) number(value);
        number(samples_per_second(row));
        number(rays_per_second(row));
        if (row.factor) {
            const Ratio& ratio = row.factor->ratio;
            number(ratio.value);
            cells.push_back(ratio.interval ? fmt::format("{}", ratio.interval->low) : "");
            cells.push_back(ratio.interval ? fmt::format("{}", ratio.interval->high) : "");
            cells.push_back(row.factor->over);
        } else {
            cells.insert(cells.end(), 4, "");
        }
        for (const std::string& name : phases) {
            for (std::string& cell : phase_cells(row, name)) cells.push_back(std::move(cell));
        }
#define TANDEM_COUNTER(name, words) number(row.counters.name);
#include "tandem/render/counters.def"
#undef TANDEM_COUNTER
        for (const std::string& name : figures) cells.push_back(figure_of(row, name));
        append_line(csv, cells);
    }
    return csv;
}

}  // namespace tandem
