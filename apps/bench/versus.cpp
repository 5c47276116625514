#include "versus.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "frame_timing.h"
#include "output.h"
#include "rate_plot.h"
#include "tandem/base/error.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/images/compare.h"
#include "tandem/report/format_number.h"

namespace tandem::bench {

namespace {

std::vector<double> phase_seconds(const BenchmarkRow& row, const std::string& name) {
    for (const PhaseTimings& timings : row.phases) {
        if (timings.name == name) return timings.seconds;
    }
    return {};
}

/// "cuda over cpu: 12.9 (12.5 to 13.3)" for one phase, from the first row to each of the others.
Table ratio_table(const std::vector<BenchmarkRow>& rows, const std::vector<std::string>& phases) {
    Table table{
        fmt::format("Times as fast as {}; the 95 % interval is in brackets", rows.front().label), {{"What"}}, {}};
    for (std::size_t i = 1; i < rows.size(); ++i) table.columns.push_back({rows[i].label, true});
    for (const std::string& name : phases) {
        std::vector<std::string> cells = {name};
        const std::vector<double> base = phase_seconds(rows.front(), name);
        for (std::size_t i = 1; i < rows.size(); ++i) {
            cells.push_back(format_ratio(ratio_of_medians(base, phase_seconds(rows[i], name))));
        }
        table.rows.push_back(std::move(cells));
    }
    return table;
}

Table phase_table(const std::vector<BenchmarkRow>& rows) {
    Table table{
        "Median and median absolute deviation; \"frame\" is the wall-clock time from the loaded scene to the film "
        "in the host's memory",
        {{"Row"}},
        {}};
    for (const PhaseTimings& timings : rows.front().phases) table.columns.push_back({timings.name, true});
    table.columns.push_back({"Samples/s (render)", true});
    for (const BenchmarkRow& row : rows) {
        std::vector<std::string> cells = {row.label};
        for (const PhaseTimings& timings : row.phases) {
            cells.push_back(format_summary(summarize(timings.seconds)));
        }
        cells.push_back(format_count(samples_per_second(row)));
        table.rows.push_back(std::move(cells));
    }
    return table;
}

BarPlot rate_plot_of(const std::string& title, const std::string& unit, const std::vector<BenchmarkRow>& rows,
                     double (*rate)(const BenchmarkRow&)) {
    std::vector<const BenchmarkRow*> pointers;
    pointers.reserve(rows.size());
    for (const BenchmarkRow& row : rows) pointers.push_back(&row);
    return rate_plot(title, unit, pointers, rate);
}

/// Whether equal bits are required: the tier fast does not guarantee them.
Callout::Kind kind_of(std::size_t differences, Tier tier) {
    if (differences == 0) return Callout::Kind::good;
    return tier == Tier::fast ? Callout::Kind::note : Callout::Kind::bad;
}

bool versus_frames(const VersusOptions& options, const std::vector<std::string>& names, const BackendSource& source,
                   Report& report) {
    log_progress(fmt::format("{}: {} rounds of {}", options.scene, options.repetitions, fmt::join(names, " and ")));
    const Scene scene = load_scene(options.scene, nullptr, {.aspect = aspect_of(options.size)});
    RenderJob job{options.size.width,
                  options.size.height,
                  options.samples,
                  options.seed,
                  static_cast<std::uint32_t>(options.frame),
                  parse_tier(options.tier)};
    std::vector<std::unique_ptr<Backend>> backends;
    std::vector<BenchmarkRow> rows;
    std::vector<Film> films;
    bool equal = true;
    for (const std::string& name : names) {
        backends.push_back(source.make(name, {options.threads, 16, {}}));
        describe_backend(*backends.back(), report);
        BenchmarkRow& row = rows.emplace_back();
        row.label = name;
        row.scene = options.scene;
        row.backend = name;
        row.tier = to_string(job.tier);
        row.samples = sample_count(job);
        if (name != "cuda") row.threads = options.threads;
        films.push_back(render_timed(*backends.back(), scene, job).film);  // warms up
    }
    for (int round = 0; round < options.repetitions; ++round) {
        for (const std::size_t i : interleaved_order(names.size(), static_cast<std::size_t>(round))) {
            const TimedFrame timed = render_timed(*backends[i], scene, job);
            record(rows[i], round, timed.stats.seconds.render, timed);
        }
    }
    report.blocks.emplace_back(phase_table(rows));
    if (rows.size() > 1) report.blocks.emplace_back(ratio_table(rows, {"render", "frame"}));
    report.blocks.emplace_back(
        rate_plot_of("Samples per second of the render phase", "samples/s", rows, samples_per_second));
    for (std::size_t i = 1; i < films.size(); ++i) {
        const FilmDifference difference = compare(films[0], films[i]);
        equal = equal && difference.differing_sums == 0;
        report.blocks.emplace_back(
            Callout{kind_of(difference.differing_sums, job.tier),
                    fmt::format("{} of {} pixels differ between {} and {}.", difference.differing_sums,
                                difference.pixels, names[0], names[i])});
        rows[i].factor = factor_over(rows[0], rows[i]);
        for (const Tolerance tolerance : tolerances) {
            rows[i].errors.push_back({names[0], to_string(tolerance), difference.residual_rate(tolerance)});
        }
    }
    report.properties.emplace_back("film", film_hash(films[0]));
    report.rows.insert(report.rows.end(), rows.begin(), rows.end());
    return equal || job.tier == Tier::fast;
}

bool versus_rays(const VersusOptions& options, const std::vector<std::string>& names, const BackendSource& source,
                 Report& report) {
    RayTiming timing = time_rays(options, names, source, report);
    Table table{fmt::format("{} {} rays, {} of them hit; build and upload are separate",
                            format_number(timing.rows.front().rays), to_string(*options.rays),
                            format_share(static_cast<double>(timing.hits) / timing.rows.front().rays)),
                {{"Row"}, {"Trace", true}, {"Rays/s", true}, {"Build", true}, {"Upload", true}},
                {}};
    for (BenchmarkRow& row : timing.rows) {
        table.rows.push_back({row.label, format_summary(summarize(row.seconds)), format_count(rays_per_second(row)),
                              format_summary(summarize(phase_seconds(row, "build"))),
                              format_summary(summarize(phase_seconds(row, "upload")))});
        if (&row != &timing.rows.front()) row.factor = factor_over(timing.rows.front(), row);
    }
    report.blocks.emplace_back(table);
    for (const BenchmarkRow& row : timing.rows) {
        if (!row.factor) continue;
        report.blocks.emplace_back(Paragraph{fmt::format("{} is {} times as fast as {}.", row.label,
                                                         format_ratio(row.factor->ratio), row.factor->over)});
    }
    report.blocks.emplace_back(rate_plot_of("Rays per second", "rays/s", timing.rows, rays_per_second));
    if (names.size() > 1) {
        report.blocks.emplace_back(Callout{kind_of(timing.differing_hits, parse_tier(options.tier)),
                                           fmt::format("{} hits differ among {}, in id or in any bit of t.",
                                                       timing.differing_hits, fmt::join(names, ", "))});
    }
    if (timing.has_native) {
        report.blocks.emplace_back(
            Callout{Callout::Kind::note,
                    fmt::format("Raw Embree names another primitive for {} of these rays: its own tests are "
                                "approximate (docs/numerics.md).",
                                timing.native_ids)});
    }
    report.properties.emplace_back("differing hits", fmt::format("{}", timing.differing_hits));
    report.rows.insert(report.rows.end(), timing.rows.begin(), timing.rows.end());
    return timing.differing_hits == 0 || parse_tier(options.tier) == Tier::fast;
}

}  // namespace

bool run_versus(const VersusOptions& options, const BackendSource& source, Report& report) {
    report.title = "Versus: " + options.scene;
    report.summary =
        options.rays
            ? fmt::format("Rays per second, {} rays, {} rounds in alternating order.", to_string(*options.rays),
                          options.repetitions)
            : fmt::format("Frame {} at {} x {} with {} samples per pixel, tier {}, {} rounds in alternating order.",
                          options.frame, options.size.width, options.size.height, options.samples, options.tier,
                          options.repetitions);
    const std::vector<std::string> names = available_backends(source, options.backends, report);
    if (names.empty()) throw EnvironmentError("none of the requested backends can run on this machine");
    if (names.size() == 1) {
        report.blocks.emplace_back(
            Callout{Callout::Kind::note,
                    fmt::format("Only {} can run here: there is nothing to compare its times with.", names[0])});
    }
    return options.rays ? versus_rays(options, names, source, report) : versus_frames(options, names, source, report);
}

}  // namespace tandem::bench
