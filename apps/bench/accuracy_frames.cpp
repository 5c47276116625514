// The part of `accuracy` that renders frames.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "accuracy.h"
#include "frame_timing.h"
#include "output.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/images/compare.h"
#include "tandem/report/format_number.h"

namespace tandem::bench {

namespace {

/// One contender's frame of one scene.
struct FrameOutcome {
    BenchmarkRow row;
    Film film;
};

std::vector<FrameOutcome> measure(const AccuracyOptions& options, const AccuracyStage& stage, const std::string& name) {
    log_progress(fmt::format("{}: {} rounds of {} contenders", name, options.repetitions, stage.entries.size()));
    const Scene scene = load_scene(name, nullptr, {.aspect = aspect_of(options.size)});
    std::vector<FrameOutcome> outcomes;
    const auto job_of = [&](Tier tier) {
        return RenderJob{options.size.width, options.size.height, options.samples, options.seed, 0, tier};
    };
    for (const AccuracyStage::Entry& entry : stage.entries) {
        FrameOutcome& o = outcomes.emplace_back();
        o.row.label = entry.name.label();
        o.row.scene = name;
        o.row.backend = entry.name.backend;
        o.row.tier = to_string(entry.name.tier);
        o.row.samples = sample_count(job_of(entry.name.tier));
        if (o.row.backend != "cuda") o.row.threads = options.threads;
        o.film = render_timed(*entry.backend, scene, job_of(entry.name.tier)).film;
    }
    for (int round = 0; round < options.repetitions; ++round) {
        for (const std::size_t i : interleaved_order(outcomes.size(), static_cast<std::size_t>(round))) {
            const TimedFrame timed = render_timed(*stage.entries[i].backend, scene, job_of(stage.entries[i].name.tier));
            record(outcomes[i].row, round, timed.stats.seconds.render, timed);
        }
    }
    return outcomes;
}

/// The first film of a tier.
const Film* film_in(const std::vector<FrameOutcome>& outcomes, Tier tier) {
    for (const FrameOutcome& o : outcomes) {
        if (o.row.tier == to_string(tier)) return &o.film;
    }
    return nullptr;
}

/// False if two films of an exact tier differ.
bool equal_where_promised(const std::vector<FrameOutcome>& outcomes, Report& report) {
    bool equal = true;
    for (const Tier tier : {Tier::strict, Tier::precise}) {
        const Film* first = film_in(outcomes, tier);
        for (const FrameOutcome& o : outcomes) {
            if (o.row.tier != to_string(tier)) continue;
            const std::size_t differing = compare(*first, o.film).differing_sums;
            if (differing == 0) continue;
            equal = false;
            report.blocks.emplace_back(
                Callout{Callout::Kind::bad, fmt::format("{}: {} pixels of {} differ from the other backend's.",
                                                        o.row.scene, differing, o.row.label)});
        }
    }
    return equal;
}

}  // namespace

bool accuracy_of_frames(const AccuracyOptions& options, const AccuracyStage& stage, Report& report) {
    Table table{
        fmt::format("Frames of {} x {} with {} samples per pixel; differences from the film of the tier precise",
                    options.size.width, options.size.height, options.samples),
        {{"Scene"},
         {"Backend and tier"},
         {"Render", true},
         {"Samples/s", true},
         {"Times the fastest", true},
         {"Registers", true},
         {"Mean difference", true},
         {"Largest", true},
         {"Pixels off by 1/255", true}},
        {}};
    bool equal = true;
    for (const std::string& name : options.scenes) {
        std::vector<FrameOutcome> outcomes = measure(options, stage, name);
        equal = equal_where_promised(outcomes, report) && equal;
        std::map<std::string, double> fastest = fastest_medians(outcomes);
        const Film* reference = film_in(outcomes, Tier::precise);
        for (FrameOutcome& o : outcomes) {
            std::vector<std::string> cells = {name,
                                              o.row.label,
                                              format_summary(summarize(o.row.seconds)),
                                              format_count(samples_per_second(o.row)),
                                              format_price(median(o.row.seconds), fastest[o.row.backend]),
                                              o.row.registers > 0 ? fmt::format("{}", o.row.registers) : "",
                                              "",
                                              "",
                                              ""};
            if (reference != nullptr) {
                const FilmDifference difference = compare(*reference, o.film);
                cells[6] = fmt::format("{:.1e}", difference.mean);
                cells[7] = fmt::format("{:.1e}", difference.largest);
                cells[8] = format_share(difference.residual_rate(Tolerance::one_level));
                for (const Tolerance tolerance : tolerances) {
                    o.row.errors.push_back({"precise", to_string(tolerance), difference.residual_rate(tolerance)});
                }
            }
            table.rows.push_back(std::move(cells));
        }
        for (FrameOutcome& o : outcomes) report.rows.push_back(std::move(o.row));
    }
    report.blocks.emplace_back(Heading{"A frame"});
    report.blocks.emplace_back(std::move(table));
    if (equal) {
        report.blocks.emplace_back(
            Callout{Callout::Kind::good, "Strict and precise gave equal bits on every backend."});
    }
    return equal;
}

}  // namespace tandem::bench
