// The part of `accuracy` that traces rays.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "accuracy.h"
#include "kind_scenes.h"
#include "output.h"
#include "tandem/math/ulp.h"
#include "tandem/oracle/oracle.h"
#include "tandem/report/format_number.h"

namespace tandem::bench {

namespace {

/// The errors of the checked rays, relative to the oracle.
struct RayErrors {
    std::size_t checked = 0;
    std::size_t wrong = 0;      ///< another primitive, or a hit for a miss
    std::vector<double> ulps;   ///< of t, where the primitive is right
    double worst_relative = 0;  ///< of t before its rounding to float

    [[nodiscard]] double worst_ulp() const { return ulps.empty() ? 0 : *std::max_element(ulps.begin(), ulps.end()); }
    [[nodiscard]] double share(std::size_t count) const {
        return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(1, checked));
    }
};

struct Answers {
    std::vector<Hit> hits;
    std::vector<double> wide_t;
};

RayErrors compare(const Answers& answers, const std::vector<OracleHit>& truth) {
    RayErrors errors;
    errors.checked = truth.size();
    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (answers.hits[i].primitive != truth[i].primitive) {
            ++errors.wrong;
        } else if (truth[i].primitive != no_primitive) {
            const auto exact = static_cast<double>(truth[i].t);
            errors.ulps.push_back(error_in_ulp(answers.hits[i].t, exact));
            errors.worst_relative = std::max(errors.worst_relative, std::abs(answers.wide_t[i] - exact) / exact);
        }
    }
    return errors;
}

struct RaysOutcome {
    BenchmarkRow row;
    std::shared_ptr<ResidentScene> resident;
    Answers answers;
    RayErrors errors;
};

bool same_bits(const Answers& a, const Answers& b) {
    for (std::size_t i = 0; i < a.hits.size(); ++i) {
        if (a.hits[i].primitive != b.hits[i].primitive || bits_of(a.wide_t[i]) != bits_of(b.wide_t[i])) return false;
    }
    return true;
}

/// All contenders on one scene. False if an exact tier is wrong or its backends disagree.
bool measure(const AccuracyOptions& options, const AccuracyStage& stage, const KindScene& kind, Table& table,
             Report& report) {
    const char* difficulty = kind.difficulty == Difficulty::easy ? "easy" : "hard";
    log_progress(fmt::format("{} rays toward each {}, {}", options.rays, kind.kind, difficulty));
    // Compare one trace of every contender with the oracle
    std::vector<OracleHit> truth;
    const auto checked = static_cast<std::size_t>(std::min(options.checked_rays, options.rays));
    truth.reserve(checked);
    for (std::size_t i = 0; i < checked; ++i) truth.push_back(oracle_trace(kind.scene, kind.rays[i]));
    std::vector<RaysOutcome> outcomes;
    for (const AccuracyStage::Entry& entry : stage.entries) {
        RaysOutcome& o = outcomes.emplace_back();
        o.row.label = entry.name.label();
        o.row.scene = fmt::format("{}, {}", kind.kind, difficulty);
        o.row.backend = entry.name.backend;
        o.row.tier = to_string(entry.name.tier);
        o.row.rays = static_cast<double>(kind.rays.size());
        if (o.row.backend != "cuda") o.row.threads = options.threads;
        o.resident = entry.backend->load(kind.scene, entry.name.tier);
        o.answers.hits.resize(kind.rays.size());
        o.answers.wide_t.resize(kind.rays.size());
        entry.backend->trace(
            *o.resident,
            {.rays = kind.rays, .hits = o.answers.hits, .wide_t = o.answers.wide_t, .counters = &o.row.counters});
        o.errors = compare(o.answers, truth);
    }
    // Time all contenders in rounds
    std::vector<Hit> scratch(kind.rays.size());
    for (int round = 0; round < options.repetitions; ++round) {
        for (const std::size_t i : interleaved_order(outcomes.size(), static_cast<std::size_t>(round))) {
            RaysOutcome& o = outcomes[i];
            o.row.seconds.push_back(stage.entries[i].backend->trace(*o.resident, kind.rays, scratch));
            o.row.rounds.push_back(round);
        }
    }
    // Judge and report the outcomes
    std::map<std::string, double> fastest = fastest_medians(outcomes);
    bool right = true;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        RaysOutcome& o = outcomes[i];
        const bool exact = stage.entries[i].name.tier != Tier::fast;
        if (exact && (o.errors.wrong > 0 || o.errors.worst_ulp() > 1)) right = false;
        for (std::size_t j = 0; exact && j < i; ++j) {
            if (stage.entries[j].name.tier != stage.entries[i].name.tier) continue;
            if (same_bits(outcomes[j].answers, o.answers)) continue;
            right = false;
            report.blocks.emplace_back(
                Callout{Callout::Kind::bad, fmt::format("{}: {} and {} differ in a bit.", o.row.scene,
                                                        stage.entries[j].name.label(), o.row.label)});
        }
        const double seconds = median(o.row.seconds);
        const double worst = o.errors.worst_ulp();
        table.rows.push_back({o.row.scene, o.row.label, format_seconds(seconds / o.row.rays),
                              format_price(seconds, fastest[o.row.backend]),
                              format_share(o.errors.share(o.errors.wrong)), format_number(worst),
                              format_number(o.errors.ulps.empty() ? 0 : median(o.errors.ulps)),
                              fmt::format("{:.1e}", o.errors.worst_relative)});
        const auto beyond = std::count_if(o.errors.ulps.begin(), o.errors.ulps.end(), [](double u) { return u > 1; });
        o.row.errors = {{"oracle", "another primitive", o.errors.share(o.errors.wrong)},
                        {"oracle", "t beyond 1 ulp", o.errors.share(static_cast<std::size_t>(beyond))}};
        o.row.note = fmt::format("worst t {} ulp", format_number(worst));
        report.rows.push_back(std::move(o.row));
    }
    return right;
}

}  // namespace

bool accuracy_of_rays(const AccuracyOptions& options, const AccuracyStage& stage, Report& report) {
    Table table{fmt::format("{} rays per kind of primitive, {} of them checked against the oracle. \"Wrong\": not the "
                            "nearest primitive. Errors of t are in float ulps; the relative "
                            "error is that of t in the tier's own precision",
                            format_number(options.rays), format_number(std::min(options.checked_rays, options.rays))),
                {{"Rays toward"},
                 {"Backend and tier"},
                 {"Time per ray", true},
                 {"Times the fastest", true},
                 {"Wrong", true},
                 {"Worst ulp", true},
                 {"Median ulp", true},
                 {"Worst relative", true}},
                {}};
    bool right = true;
    for (const std::string& kind : primitive_kinds()) {
        for (const Difficulty difficulty : {Difficulty::easy, Difficulty::hard}) {
            const KindScene scene = make_kind_scene(kind, difficulty, static_cast<std::size_t>(options.rays));
            right = measure(options, stage, scene, table, report) && right;
        }
    }
    report.blocks.emplace_back(Heading{"A ray"});
    report.blocks.emplace_back(std::move(table));
    report.blocks.emplace_back(
        right ? Callout{Callout::Kind::good,
                        "Strict and precise decided every ray correctly, with t within one ulp and "
                        "equal bits on every backend."}
              : Callout{Callout::Kind::bad, "A tier that guarantees correct decisions and equal bits failed."});
    return right;
}

}  // namespace tandem::bench
