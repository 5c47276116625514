#include "tandem/report/json_writer.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "tandem/effects/names.h"

namespace tandem {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const std::optional<Interval>& interval) {
    return interval ? Json::array({interval->low, interval->high}) : Json();
}

Json json_of(const Summary& summary) {
    return {{"count", summary.count}, {"median", summary.median}, {"median_absolute_deviation", summary.deviation},
            {"min", summary.least},   {"max", summary.most},      {"interval_95", json_of(summary.interval)}};
}

Json json_of(const Machine& machine) {
    Json more = Json::object();
    for (const auto& [name, value] : machine.more) more[name] = value;
    return {{"processor", machine.processor},
            {"cores", machine.cores},
            {"core_quota", machine.core_quota ? Json(*machine.core_quota) : Json()},
            {"instruction_sets", machine.instruction_sets},
            {"memory_bytes", machine.memory_bytes},
            {"system", machine.system},
            {"compiler", machine.compiler},
            {"flags", machine.flags},
            {"commit", machine.commit},
            {"load_average", machine.load},
            {"more", more}};
}

Json json_of(const RenderCounters& counters) {
    Json json = Json::object();
#define TANDEM_COUNTER(name, words) json[#name] = counters.name;
#include "tandem/render/counters.def"
#undef TANDEM_COUNTER
    return json;
}

Json json_of(const BenchmarkRow& row) {
    Json phases = Json::object();
    for (const PhaseTimings& timings : row.phases) {
        phases[timings.name] = {{"summary", json_of(summarize(timings.seconds))}, {"seconds", timings.seconds}};
    }
    Json errors = Json::array();
    for (const ErrorFigure& error : row.errors) {
        errors.push_back({{"against", error.against}, {"tolerance", error.tolerance}, {"share", error.share}});
    }
    Json figures = Json::object();
    for (const auto& [name, value] : row.figures) figures[name] = value;
    Json series = Json::object();
    for (const auto& [name, values] : row.series) series[name] = values;
    Json factor;
    if (row.factor) {
        factor = {{"over", row.factor->over},
                  {"value", row.factor->ratio.value},
                  {"interval_95", json_of(row.factor->ratio.interval)},
                  {"pairs", row.factor->ratio.pairs}};
    }
    return {{"label", row.label},
            {"scene", row.scene},
            {"backend", row.backend},
            {"variant", row.variant},
            {"tier", row.tier},
            {"threads", row.threads},
            {"effects", to_string(row.effects)},
            {"carried", to_string(row.carried)},
            {"summary", json_of(summarize(row.seconds))},
            {"seconds", row.seconds},
            {"rounds", row.rounds},
            {"phases", phases},
            {"samples", row.samples},
            {"samples_per_second", samples_per_second(row)},
            {"rays", row.rays},
            {"rays_per_second", rays_per_second(row)},
            {"factor", factor},
            {"errors", errors},
            {"figures", figures},
            {"series", series},
            {"counters", json_of(row.counters)},
            {"registers", row.registers},
            {"occupancy", row.occupancy},
            {"note", row.note}};
}

Json json_of(const Axis& axis) { return {{"label", axis.label}, {"logarithmic", axis.logarithmic}}; }

Json json_of(const std::vector<ReferenceValue>& references) {
    Json list = Json::array();
    for (const ReferenceValue& reference : references) {
        list.push_back({{"label", reference.label}, {"value", reference.value}});
    }
    return list;
}

/// A plot with two axes, and what it shows.
template <class Plot>
Json plot_with(const Plot& plot, const char* name, Json content) {
    return {{"title", plot.title},
            {"x", json_of(plot.x)},
            {"y", json_of(plot.y)},
            {name, std::move(content)},
            {"references", json_of(plot.references)}};
}

Json json_of(const LinePlot& plot) {
    Json lines = Json::array();
    for (const Line& line : plot.lines) {
        Json points = Json::array();
        for (const Point& point : line.points) points.push_back({point.x, point.y});
        lines.push_back({{"label", line.label}, {"points", points}});
    }
    return plot_with(plot, "lines", std::move(lines));
}

Json json_of(const BarPlot& plot) {
    Json bars = Json::array();
    for (const Bar& bar : plot.bars) {
        bars.push_back({{"label", bar.label}, {"value", bar.value}, {"interval_95", json_of(bar.interval)}});
    }
    return {{"title", plot.title},
            {"value", json_of(plot.value)},
            {"bars", bars},
            {"references", json_of(plot.references)}};
}

Json json_of(const ScatterPlot& plot) {
    Json series = Json::array();
    for (const ScatterSeries& one : plot.series) {
        Json points = Json::array();
        for (const ScatterPoint& point : one.points) {
            points.push_back({{"label", point.label},
                              {"mark", point.mark},
                              {"shape", plot.shapes.empty() ? "" : plot.shapes[point.shape % plot.shapes.size()]},
                              {"x", point.at.x},
                              {"y", point.at.y},
                              {"x_interval_95", json_of(std::optional(point.x))},
                              {"y_interval_95", json_of(std::optional(point.y))},
                              {"faded", point.faded},
                              {"failed", point.failed}});
        }
        series.push_back({{"label", one.label}, {"points", points}});
    }
    return plot_with(plot, "series", std::move(series));
}

Json json_of(const Table& table) {
    Json columns = Json::array();
    for (const Table::Column& column : table.columns) columns.push_back(column.name);
    return {{"caption", table.caption}, {"columns", columns}, {"rows", table.rows}};
}

const char* kind_name(Callout::Kind kind) {
    switch (kind) {
        case Callout::Kind::good:
            return "good";
        case Callout::Kind::bad:
            return "bad";
        case Callout::Kind::note:
            return "note";
    }
    return "note";
}

/// Sorts blocks into the lists of the document; prose is only on the page.
struct BlockCollector {
    Json& document;

    void operator()(const Table& table) const { document["tables"].push_back(json_of(table)); }
    void operator()(const LinePlot& plot) const { document["plots"].push_back(json_of(plot)); }
    void operator()(const BarPlot& plot) const { document["plots"].push_back(json_of(plot)); }
    void operator()(const ScatterPlot& plot) const { document["plots"].push_back(json_of(plot)); }
    void operator()(const Callout& callout) const {
        document["callouts"].push_back({{"kind", kind_name(callout.kind)}, {"text", callout.text}});
    }
    void operator()(const Heading&) const {}
    void operator()(const Paragraph&) const {}
    void operator()(const Command&) const {}
    void operator()(const PictureGrid&) const {}
    void operator()(const PictureComparison&) const {}
};

}  // namespace

std::string to_json(const Report& report) {
    Json document = {{"title", report.title}, {"command", report.command}, {"machine", json_of(report.machine)}};
    document["properties"] = Json::object();
    for (const auto& [name, value] : report.properties) document["properties"][name] = value;
    document["counters"] = json_of(report.counters);
    for (const char* list : {"callouts", "rows", "tables", "plots"}) document[list] = Json::array();
    for (const BenchmarkRow& row : report.rows) document["rows"].push_back(json_of(row));
    for (const Block& block : report.blocks) std::visit(BlockCollector{document}, block);
    for (const Callout& callout : counter_callouts(report)) BlockCollector{document}(callout);
    // Device names may not be UTF-8; that must not make a report fail.
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tandem
