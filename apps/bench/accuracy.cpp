#include "accuracy.h"

#include <fmt/format.h>

#include "tandem/base/error.h"
#include "tiers.h"

namespace tandem::bench {

std::string format_price(double seconds, double fastest) {
    return fastest > 0 ? fmt::format("{:.2f}", seconds / fastest) : "-";
}

bool run_accuracy(const AccuracyOptions& options, const BackendSource& source, Report& report) {
    if (report.title.empty()) {
        report.title = "Accuracy: time and error of every tier";
        report.summary =
            "Every tier on every backend. Errors of rays are relative to the oracle, which tests every primitive with "
            "64-bit significands; errors of frames are relative to the tier precise with the same samples.";
    }
    const std::vector<Tier> tiers = parse_tiers(options.tiers);
    AccuracyStage stage;
    for (const std::string& name : available_backends(source, options.backends, report)) {
        stage.backends.push_back(source.make(name, {options.threads, 16, {}}));
        describe_backend(*stage.backends.back(), report);
        for (const Tier tier : tiers) stage.entries.push_back({{name, tier}, stage.backends.back().get()});
    }
    if (stage.entries.empty()) throw EnvironmentError("none of the requested backends can run on this machine");
    const bool rays = !options.with_rays || accuracy_of_rays(options, stage, report);
    const bool frames = !options.with_frames || accuracy_of_frames(options, stage, report);
    return rays && frames;
}

}  // namespace tandem::bench
