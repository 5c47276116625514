#include "targets.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <thread>

#include "output.h"
#include "tandem/base/error.h"
#include "target_list.h"
#include "target_run.h"

namespace tandem::bench {

namespace {

const char* in_words(Verdict verdict) {
    switch (verdict) {
        case Verdict::met:
            return "met";
        case Verdict::missed:
            return "MISSED";
        case Verdict::not_measured:
            return "not measured";
    }
    return "";
}

void check_ids(const std::vector<std::string>& wanted, const std::vector<Target>& targets) {
    std::vector<std::string> known;
    known.reserve(targets.size());
    for (const Target& one : targets) known.push_back(one.description.id);
    for (const std::string& id : wanted) {
        if (std::find(known.begin(), known.end(), id) == known.end()) {
            throw InputError(fmt::format("--only: there is no target '{}' on this machine; the targets are {}", id,
                                         fmt::join(known, ", ")));
        }
    }
}

int core_count() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

void report_results(const std::vector<TargetResult>& results, Report& report) {
    Table table{"The measured value decides; its 95 % interval is in brackets",
                {{"Target"}, {"Requirement"}, {"Measured", true}, {"Verdict"}},
                {}};
    std::size_t missed = 0, met = 0;
    for (const TargetResult& result : results) {
        const bool measured = result.verdict != Verdict::not_measured;
        table.rows.push_back(
            {result.id, result.statement, measured ? result.shown : result.why_not, in_words(result.verdict)});
        missed += result.verdict == Verdict::missed ? 1 : 0;
        met += result.verdict == Verdict::met ? 1 : 0;
        report.properties.emplace_back("target " + result.id, in_words(result.verdict));
        if (measured) report.properties.emplace_back("measured " + result.id, fmt::format("{}", result.measured));
        report.properties.emplace_back("required " + result.id, fmt::format("{}", result.required));
        report.properties.emplace_back("command " + result.id, result.command);
    }
    report.blocks.emplace_back(std::move(table));
    report.blocks.emplace_back(Callout{missed == 0 ? Callout::Kind::good : Callout::Kind::bad,
                                       fmt::format("{} targets met, {} missed, {} not measurable on this machine.", met,
                                                   missed, results.size() - met - missed)});
}

}  // namespace

std::vector<TargetResult> list_targets(int cores) {
    std::vector<TargetResult> results;
    for (Target& one : all_targets(cores)) results.push_back(std::move(one.description));
    return results;
}

bool run_targets(const TargetOptions& options, const BackendSource& source, Report& report) {
    report.title = "Targets";
    report.summary =
        fmt::format("Performance targets, measured in one run: {} rounds in alternating order.", options.repetitions);
    std::vector<Target> targets = all_targets(core_count());
    check_ids(options.only, targets);
    const std::string no_gpu = source.why_unavailable("cuda");
    std::vector<TargetResult> results;
    TargetRun run(options, source, report);
    for (Target& one : targets) {
        TargetResult& result = one.description;
        if (!options.only.empty() &&
            std::find(options.only.begin(), options.only.end(), result.id) == options.only.end()) {
            continue;
        }
        if (one.needed_gpus > 0 && !no_gpu.empty()) {
            result.why_not = "no GPU: " + no_gpu;
        } else if (one.needed_gpus > 1 && source.gpu_count() < one.needed_gpus) {
            const int there = source.gpu_count();
            result.why_not = "not run: " + (there == 1 ? "one GPU" : gpus_in_words(there));
        } else {
            log_progress("targets: " + result.id);
            one.measure(run, result);
        }
        results.push_back(std::move(result));
    }
    report_results(results, report);
    return std::none_of(results.begin(), results.end(),
                        [](const TargetResult& result) { return result.verdict == Verdict::missed; });
}

}  // namespace tandem::bench
