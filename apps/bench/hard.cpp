#include "hard.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>

#include "hard/corpus/error_bounds.h"
#include "hard/corpus/exchange.h"
#include "hard/corpus/hard_case.h"
#include "output.h"
#include "tandem/base/error.h"
#include "tandem/report/format_number.h"
#include "tiers.h"

namespace tandem::bench {

namespace {

using hard::HardCase;
using hard::Score;

/// Kernel functions are tested on the host, whatever the backends.
constexpr const char* host = "host";

/// Scientific notation, with two digits, from 1e5 on: the errors range from one ulp to all bits.
std::string format_ulps(double ulps) { return ulps < 1e5 ? format_number(ulps) : fmt::format("{:.1e}", ulps); }

/// A row of the table.
struct Result {
    std::string id;
    std::string title;
    std::string backend;
    std::string tier;
    Score score;
    const ErrorBound* bound = nullptr;
    double times_fastest = 0;  ///< 0 where nothing was timed
};

/// How a score exceeds its error bound; empty if it keeps it.
std::string shortfall(const Score& score, const ErrorBound& bound) {
    std::vector<std::string> missed;
    const auto tried = static_cast<double>(score.tried);
    const auto share = [&](std::size_t count, double most, const char* what) {
        if (static_cast<double>(count) > most * tried) missed.push_back(fmt::format("{} {}", count, what));
    };
    share(score.wrong, bound.wrong, "wrong");
    share(score.leaks, bound.leaks, "leaks");
    share(score.nans, 0, "NaN");
    if (!(score.worst_ulps() <= bound.ulps)) missed.push_back(fmt::format("{} ulp", format_ulps(score.worst_ulps())));
    return fmt::format("{}", fmt::join(missed, ", "));
}

Table table_of(const std::vector<Result>& results, const std::string& caption) {
    Table table{caption,
                {{"Case"},
                 {"Backend"},
                 {"Tier"},
                 {"Tried", true},
                 {"Not judged", true},
                 {"Wrong", true},
                 {"Leaks", true},
                 {"NaN", true},
                 {"Refused", true},
                 {"Worst ulp", true},
                 {"Median ulp", true},
                 {"Time", true},
                 {"Bound"}},
                {}};
    for (const Result& r : results) {
        const Score& s = r.score;
        const std::string missed = r.bound == nullptr ? "" : shortfall(s, *r.bound);
        table.rows.push_back({fmt::format("{} {}", r.id, r.title), r.backend, r.tier, fmt::format("{}", s.tried),
                              fmt::format("{}", s.unjudged), fmt::format("{}", s.wrong), fmt::format("{}", s.leaks),
                              fmt::format("{}", s.nans), fmt::format("{}", s.refused), format_ulps(s.worst_ulps()),
                              format_ulps(s.median_ulps()),
                              r.times_fastest == 0 ? "" : fmt::format("{:.2f}", r.times_fastest),
                              missed.empty() ? "kept" : "EXCEEDED: " + missed});
    }
    return table;
}

/// A row of the table for JSON and CSV: the shares and the time.
BenchmarkRow row_of(const Result& result) {
    BenchmarkRow row;
    row.label = result.id;
    row.scene = result.title;
    row.backend = result.backend;
    row.tier = result.tier;
    const auto tried = static_cast<double>(std::max<std::size_t>(1, result.score.tried));
    if (result.score.seconds > 0) {
        row.seconds = {result.score.seconds};
        row.rays = static_cast<double>(result.score.tried);
    }
    row.errors = {{"exact", "wrong", static_cast<double>(result.score.wrong) / tried},
                  {"exact", "leaks", static_cast<double>(result.score.leaks) / tried}};
    row.note = result.score.first_failure;
    return row;
}

/// Adds the table, a sentence for each row that exceeds its error bound, and the verdict. True if all are kept.
bool report_results(const std::vector<Result>& results, const std::string& caption, Report& report) {
    report.blocks.emplace_back(table_of(results, caption));
    std::size_t missed = 0;
    for (const Result& result : results) {
        report.rows.push_back(row_of(result));
        const std::string what = shortfall(result.score, *result.bound);
        if (what.empty()) continue;
        ++missed;
        const std::string& line =
            result.score.first_failure.empty() ? result.score.worst_description() : result.score.first_failure;
        report.blocks.emplace_back(
            Callout{Callout::Kind::bad, fmt::format("{} {} {} exceeds its error bound: {}. {}", result.id,
                                                    result.backend, result.tier, what, line)});
    }
    if (missed == 0) {
        report.blocks.emplace_back(
            Callout{Callout::Kind::good, fmt::format("All {} error bounds are kept.", results.size())});
    }
    report.properties.emplace_back("error bounds kept",
                                   fmt::format("{} of {}", results.size() - missed, results.size()));
    return missed == 0;
}

/// Divides each time by that of the fastest tier of the same case and backend.
void compare_times(std::vector<Result>& results) {
    std::map<std::pair<std::string, std::string>, double> fastest;
    for (const Result& r : results) {
        if (r.score.seconds == 0) continue;
        const auto [at, is_new] = fastest.emplace(std::pair{r.id, r.backend}, r.score.seconds);
        if (!is_new) at->second = std::min(at->second, r.score.seconds);
    }
    for (Result& r : results) {
        if (r.score.seconds > 0) r.times_fastest = r.score.seconds / fastest.at({r.id, r.backend});
    }
}

std::vector<Tier> tiers_of(const HardOptions& options) {
    std::vector<Tier> tiers = parse_tiers(options.tiers);
    if (!tiers.empty()) return tiers;
#define TANDEM_TIER(name, promise) tiers.push_back(Tier::name);
#include "tandem/render/tiers.def"
#undef TANDEM_TIER
    return tiers;
}

class Trials {
  public:
    Trials(const HardOptions& options, const BackendSource& source, Report& report)
        : options_(options), source_(source), tiers_(tiers_of(options)) {
        for (const std::string& name : available_backends(source, options.backends, report)) {
            backends_.push_back({name, source.make(name, {})});
            describe_backend(*backends_.back().backend, report);
        }
    }

    void run(const HardCase& hard_case) {
        log_progress(fmt::format("hard: {} {}", hard_case.id, hard_case.title));
        std::vector<hard::AnsweredBatch> batches;
        if (hard_case.has_rays()) batches = hard::answered_batches(hard_case, options_.rays);
        for (const Tier tier : tiers_) {
            const ErrorBound* bound = find_error_bound(hard_case.id, tier);
            if (bound == nullptr) continue;
            if (hard_case.on_host()) {
                add(hard_case, host, *bound, hard::try_functions(hard_case, tier, options_.rays));
                continue;
            }
            for (const auto& [name, backend] : backends_) {
                add(hard_case, name, *bound,
                    hard_case.has_rays() ? try_rays(hard_case, batches, *backend, tier)
                                         : try_pictures(hard_case, subject(name, tier, *backend), options_.rays));
            }
        }
    }

    [[nodiscard]] std::vector<Result>& results() { return results_; }

  private:
    struct Named {
        std::string name;
        std::unique_ptr<Backend> backend;
    };

    /// The first run warms caches and memory; the second is timed.
    static Score try_rays(const HardCase& hard_case, const std::vector<hard::AnsweredBatch>& batches, Backend& backend,
                          Tier tier) {
        (void)hard::try_rays(hard_case, batches, backend, tier);
        return hard::try_rays(hard_case, batches, backend, tier);
    }

    [[nodiscard]] hard::Subject subject(const std::string& name, Tier tier, Backend& backend) const {
        return {name, tier, backend,
                [&source = source_, name](const BackendOptions& o) { return source.make(name, o); }};
    }

    void add(const HardCase& hard_case, const std::string& backend, const ErrorBound& bound, Score score) {
        results_.push_back(
            {hard_case.id, hard_case.title, backend, to_string(bound.tier), std::move(score), &bound, 0});
    }

    const HardOptions& options_;
    const BackendSource& source_;
    std::vector<Tier> tiers_;
    std::vector<Named> backends_;
    std::vector<Result> results_;
};

bool run_export(const HardOptions& options, Report& report) {
    const auto cases = hard::select_cases(options.cases);
    const std::size_t count = hard::export_cases(cases, options.rays, options.export_folder);
    report.summary = "Scenes, rays and correct answers for another renderer.";
    report.blocks.emplace_back(Callout{
        Callout::Kind::good, fmt::format("{} cases are in {}. Write the answers to {}/answers, then run "
                                         "tandem-bench hard --check {}/answers.",
                                         count, options.export_folder, options.export_folder, options.export_folder)});
    return true;
}

bool run_check(const HardOptions& options, Report& report) {
    report.summary =
        fmt::format("The answers in {}, checked against the error bounds of the tier strict.", options.answers);
    std::vector<Result> results;
    for (hard::CheckedCase& checked : hard::check_answers(options.answers)) {
        const ErrorBound* bound = find_error_bound(checked.id, Tier::strict);
        if (bound == nullptr)
            throw InputError(
                fmt::format("{}: there is no case {}; export the corpus again", options.answers, checked.id));
        if (checked.missing.empty()) {
            results.push_back({checked.id, checked.title, "answers", "strict", std::move(checked.score), bound, 0});
        } else {
            report.blocks.emplace_back(
                Callout{Callout::Kind::note,
                        fmt::format("{} is not answered: {} does not exist.", checked.id, checked.missing)});
        }
    }
    return report_results(results, "Answers against the exact ones", report);
}

}  // namespace

bool run_hard(const HardOptions& options, const BackendSource& source, Report& report) {
    report.title = "Hard cases";
    if (!options.export_folder.empty() && !options.answers.empty()) {
        throw InputError("--export writes the corpus and --check reads answers to it; give only one at a time");
    }
    if (!options.export_folder.empty()) return run_export(options, report);
    if (!options.answers.empty()) return run_check(options, report);
    const auto cases = hard::select_cases(options.cases);
    report.summary = fmt::format(
        "{} cases with up to {} rays each, checked against exact answers. docs/accuracy.md lists the error bounds of "
        "each tier, docs/hard-corpus.md the cases.",
        cases.size(), options.rays);
    Trials trials(options, source, report);
    for (const HardCase* hard_case : cases) trials.run(*hard_case);
    if (trials.results().empty()) throw InputError("none of these cases runs on these backends and tiers");
    compare_times(trials.results());
    return report_results(trials.results(), "Time: over that of the fastest tier on this backend, from a single run",
                          report);
}

}  // namespace tandem::bench
