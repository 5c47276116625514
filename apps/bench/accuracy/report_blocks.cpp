#include "accuracy/report_blocks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "accuracy/report_words.h"
#include "tandem/report/format_number.h"

namespace tandem::bench {

namespace {

constexpr std::array phases = {"prepare", "build", "compile", "upload", "render", "download", "frame"};

std::string number_of(std::size_t index) { return fmt::format("{}", index + 1); }

std::string label_of(const SweepPoint& point) { return fmt::format("{}, {} spp", point.setting.name, point.samples); }

std::string tooltip(const SweepPoint& point, Metric metric, const std::optional<std::size_t>& by,
                    const SceneSweep& sweep) {
    std::string text =
        fmt::format("{}: {} in {}", point.row.label, in_words(point.error(metric)), format_seconds(point.seconds()));
    if (by) text += fmt::format("; dominated by {}", sweep.points[*by].row.label);
    if (!has_the_image_of_the_baseline(point.setting)) text += "; from references with this filter";
    if (!point.failures.empty()) text += fmt::format("; {}", fmt::join(point.failures, "; "));
    return text;
}

/// The points of a backend that did not fail, for choosing among them.
struct Choice {
    std::vector<const SweepPoint*> points;
    std::vector<PricedError> priced;

    Choice(const SceneSweep& sweep, const std::string& backend) {
        for (const SweepPoint& point : sweep.points) {
            if (point.row.backend != backend || !point.failures.empty()) continue;
            if (!has_the_image_of_the_baseline(point.setting)) continue;
            points.push_back(&point);
            priced.push_back(point.priced(Metric::rmse));
        }
    }
};

/// A column per backend; a row per point of the first one's baseline, whose first cells `start` writes.
template <class Start, class Cell>
Table baseline_table(std::string caption, std::vector<Table::Column> columns, const SceneSweep& sweep,
                     const std::vector<SweepBackend>& backends, Start start, Cell cell) {
    Table table{std::move(caption), std::move(columns), {}};
    std::vector<Choice> choices;
    for (const SweepBackend& backend : backends) {
        table.columns.push_back({backend.name});
        choices.emplace_back(sweep, backend.name);
    }
    for (const SweepPoint* point : sweep.ladder(backends.front().name, sweep.plan.settings.front())) {
        std::vector<std::string> row = {start(*point)};
        for (const Choice& choice : choices) {
            const std::optional<std::size_t> found = cell(choice, *point);
            row.push_back(found ? fmt::format("{}: {} in {}", label_of(*choice.points[*found]),
                                              in_words(choice.points[*found]->error(Metric::rmse)),
                                              format_seconds(choice.points[*found]->seconds()))
                                : "nothing measured");
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

}  // namespace

std::vector<std::optional<std::size_t>> dominating_points(const SceneSweep& sweep, Metric metric) {
    std::vector<std::optional<std::size_t>> result(sweep.points.size());
    std::size_t first = 0;
    while (first < sweep.points.size()) {
        std::size_t last = first;
        std::vector<PricedError> priced;
        std::vector<std::size_t> indices;
        for (; last < sweep.points.size() && sweep.points[last].row.backend == sweep.points[first].row.backend;
             ++last) {
            if (!has_the_image_of_the_baseline(sweep.points[last].setting)) continue;
            priced.push_back(sweep.points[last].priced(metric));
            indices.push_back(last);
        }
        const auto by = dominating(priced);
        for (std::size_t i = 0; i < by.size(); ++i) {
            if (by[i]) result[indices[i]] = indices[*by[i]];
        }
        first = last;
    }
    return result;
}

ScatterPlot pareto_plot(const SceneSweep& sweep, const std::vector<SweepBackend>& backends, Metric metric) {
    ScatterPlot plot{fmt::format("{}: {} against time", sweep.scene.name, to_string(metric)),
                     {"time to render a frame, seconds", true},
                     {to_string(metric), true},
                     {},
                     {},
                     {}};
    for (const Axis axis : all_axes) plot.shapes.emplace_back(to_string(axis));
    const auto by = dominating_points(sweep, metric);
    for (const SweepBackend& backend : backends) {
        ScatterSeries& series = plot.series.emplace_back(ScatterSeries{backend.name, {}});
        for (std::size_t i = 0; i < sweep.points.size(); ++i) {
            const SweepPoint& point = sweep.points[i];
            if (point.row.backend != backend.name) continue;
            const PricedError priced = point.priced(metric);
            series.points.push_back({{priced.seconds, priced.error.value},
                                     priced.seconds_interval,
                                     priced.error.interval,
                                     tooltip(point, metric, by[i], sweep),
                                     by[i] ? number_of(i) : "",
                                     static_cast<std::size_t>(point.setting.axis),
                                     by[i].has_value() || !has_the_image_of_the_baseline(point.setting),
                                     !point.failures.empty()});
        }
    }
    if (sweep.floor(metric) > 0) plot.references.push_back({"noise of each reference", sweep.floor(metric)});
    return plot;
}

Table points_table(const SceneSweep& sweep) {
    Table table{
        fmt::format("{}: every point, with 95 % intervals. Different bits: the share of pixels that differ from "
                    "{} on {} with the same seed",
                    sweep.scene.name, sweep.plan.settings.front().name, sweep.points.front().row.backend),
        {{"No.", true},
         {"Backend"},
         {"Setting"},
         {"Time", true},
         {"RMSE", true},
         {"relMSE", true},
         {"Trimmed relMSE", true},
         {"Mean FLIP", true},
         {"Different bits", true},
         {"Dominated by", true}},
        {}};
    const auto by = dominating_points(sweep, Metric::rmse);
    for (std::size_t i = 0; i < sweep.points.size(); ++i) {
        const SweepPoint& point = sweep.points[i];
        std::vector<std::string> cells = {number_of(i), point.row.backend, label_of(point),
                                          in_words(summarize(point.row.seconds))};
        for (const Metric metric : metrics) cells.push_back(in_words(point.error(metric)));
        cells.push_back(format_share(point.differing));
        cells.push_back(!point.failures.empty() ? "failed" : by[i] ? number_of(*by[i]) : "");
        table.rows.push_back(std::move(cells));
    }
    return table;
}

Table phases_table(const SceneSweep& sweep) {
    Table table{fmt::format("{}: the phases of a frame, medians with 95 % intervals", sweep.scene.name),
                {{"No.", true}, {"Setting"}},
                {}};
    for (const char* phase : phases) table.columns.push_back({phase, true});
    for (std::size_t i = 0; i < sweep.points.size(); ++i) {
        const SweepPoint& point = sweep.points[i];
        std::vector<std::string> cells = {number_of(i), point.row.label};
        for (const char* name : phases) {
            const auto found = std::find_if(point.row.phases.begin(), point.row.phases.end(),
                                            [&](const PhaseTimings& timings) { return timings.name == name; });
            cells.push_back(found == point.row.phases.end() ? "" : in_words(summarize(found->seconds)));
        }
        table.rows.push_back(std::move(cells));
    }
    return table;
}

Table equal_time_table(const SceneSweep& sweep, const std::vector<SweepBackend>& backends) {
    return baseline_table(
        fmt::format("{}: the least RMSE measured at equal time; of those that cannot be told apart, the fastest",
                    sweep.scene.name),
        {{"Within", true}}, sweep, backends, [](const SweepPoint& point) { return format_seconds(point.seconds()); },
        [](const Choice& choice, const SweepPoint& point) { return best_within(choice.priced, point.seconds()); });
}

Table equal_error_table(const SceneSweep& sweep, const std::vector<SweepBackend>& backends) {
    return baseline_table(
        fmt::format("{}: the least time measured at equal error; errors that cannot be told apart are equal",
                    sweep.scene.name),
        {{"RMSE up to", true}}, sweep, backends,
        [](const SweepPoint& point) { return format_number(point.error(Metric::rmse).value); },
        [](const Choice& choice, const SweepPoint& point) {
            return fastest_within(choice.priced, point.error(Metric::rmse));
        });
}

Table convergence_table(const SceneSweep& sweep, const std::vector<SweepBackend>& backends) {
    Table table{fmt::format("{}: how the error falls with samples: RMSE in proportion to a power of the samples per "
                            "pixel, fitted by least squares of logarithms, with 95 % intervals",
                            sweep.scene.name),
                {{"Backend"}, {"Setting"}, {"Exponent", true}, {"At the most samples", true}},
                {}};
    for (const SweepBackend& backend : backends) {
        for (const Setting& setting : sweep.plan.settings) {
            if (setting.axis != Axis::baseline && setting.axis != Axis::sampler) continue;
            const SweepPoint& last = *sweep.ladder(backend.name, setting).back();
            const std::optional<Exponent> exponent = convergence(sweep, backend.name, setting);
            table.rows.push_back({backend.name, setting.name,
                                  exponent ? in_words(*exponent) : "fewer than two errors above the noise",
                                  fmt::format("{} at {} spp", in_words(last.error(Metric::rmse)), last.samples)});
        }
    }
    return table;
}

Table scene_table() {
    Table table{"The fixed list of scenes", {{"Axis"}, {"Difficulty"}, {"Scene"}, {"Why"}}, {}};
    for (const ListedScene& listed : listed_scenes()) {
        table.rows.push_back({listed.axis, listed.difficulty, listed.scene, listed.why});
    }
    return table;
}

}  // namespace tandem::bench
