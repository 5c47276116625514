#include "tandem/report/csv_writer.h"

#include <fmt/format.h>

#include <algorithm>
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

std::string phase_median(const BenchmarkRow& row, const std::string& name) {
    for (const PhaseTimings& timings : row.phases) {
        if (timings.name == name && !timings.seconds.empty()) return fmt::format("{}", median(timings.seconds));
    }
    return {};
}

}  // namespace

std::string to_csv(std::span<const BenchmarkRow> rows) {
    const std::vector<std::string> phases = phase_names(rows);
    std::vector<std::string> header = {
        "label", "scene", "backend",       "variant",    "tier",   "threads",    "measurements", "seconds",    "mad",
        "min",   "max",   "samples_per_s", "rays_per_s", "factor", "factor_low", "factor_high",  "factor_over"};
    for (const std::string& name : phases) header.push_back(name + "_seconds");
#define TANDEM_COUNTER(name, words) header.push_back(#name);
#include "tandem/render/counters.def"
#undef TANDEM_COUNTER
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
        for (const std::string& name : phases) cells.push_back(phase_median(row, name));
#define TANDEM_COUNTER(name, words) number(row.counters.name);
#include "tandem/render/counters.def"
#undef TANDEM_COUNTER
        append_line(csv, cells);
    }
    return csv;
}

}  // namespace tandem
