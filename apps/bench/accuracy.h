/// tandem-bench accuracy: time and error of every tier on every backend.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "backend_source.h"
#include "common/arguments.h"
#include "tandem/render/tier.h"
#include "tandem/report/report.h"
#include "tandem/report/statistics.h"

namespace tandem::bench {

struct AccuracyOptions {
    std::vector<std::string> backends = {"cpu", "cuda"};
    std::vector<std::string> tiers = {"fast", "strict", "precise"};
    std::vector<std::string> scenes = {"named:paper", "named:spheres/1000000", "named:hard/planet",
                                       "named:hard/telescope"};
    FilmSize size{1000, 900};
    int samples = 16;
    std::uint64_t seed = 0;
    int threads = 0;           ///< of the CPU; 0 means one per core
    int rays = 1 << 20;        ///< per kind of primitive
    int checked_rays = 20000;  ///< how many of them, from the first, are compared with the oracle
    int repetitions = 7;
    bool with_rays = true;
    bool with_frames = true;
};

/// A backend in one of its tiers.
struct Contender {
    std::string backend;
    Tier tier;
    [[nodiscard]] std::string label() const { return backend + " " + to_string(tier); }
};

/// A backend, and the tiers that it runs in.
struct AccuracyStage {
    std::vector<std::unique_ptr<Backend>> backends;
    struct Entry {
        Contender name;
        Backend* backend;
    };
    std::vector<Entry> entries;
};

/// Traces rays at scenes of one kind each and renders the scenes; fills `report`. False if a tier that promises the
/// right decisions (strict, precise) made a wrong one or erred by more than one ulp in t, or if its backends disagree.
[[nodiscard]] bool run_accuracy(const AccuracyOptions& options, const BackendSource& source, Report& report);

// Its two parts.
[[nodiscard]] bool accuracy_of_rays(const AccuracyOptions& options, const AccuracyStage& stage, Report& report);
[[nodiscard]] bool accuracy_of_frames(const AccuracyOptions& options, const AccuracyStage& stage, Report& report);

/// The least median time of each backend, by its name. An outcome has a `row`.
template <class Outcome>
[[nodiscard]] std::map<std::string, double> fastest_medians(const std::vector<Outcome>& outcomes) {
    std::map<std::string, double> fastest;
    for (const Outcome& o : outcomes) {
        const double seconds = median(o.row.seconds);
        const auto [at, added] = fastest.emplace(o.row.backend, seconds);
        if (!added) at->second = std::min(at->second, seconds);
    }
    return fastest;
}

/// "1.00" for the fastest tier of the same backend, "1.37" for one that takes 1.37 times its time.
[[nodiscard]] std::string format_price(double seconds, double fastest);

}  // namespace tandem::bench
