/// tandem-bench coverage: do renders to a target reach it, do the stated errors and forecasts hold, and at what price?
#pragma once

#include <string>
#include <vector>

#include "backend_source.h"
#include "common/arguments.h"
#include "tandem/report/report.h"

namespace tandem::bench {

struct CoverageOptions {
    std::vector<std::string> scenes;  ///< as for the accuracy report
    std::string metric = "rmse";
    FilmSize size{64, 48};
    int trials = 200;  ///< renders, each with a seed of its own
    /// A target for each: the error of an image with as many samples in every pixel.
    std::vector<int> equal_samples = {64};
    int reference_samples = 1024;  ///< per pixel, of each of the two references that the targets are from
    int reference_factor = 32;     ///< the samples of the references of the trials, over those of a trial
    bool plans = true;             ///< a forecast before each trial
    int most_samples = 65536;      ///< per pixel, of the renders to the target
    std::string backend = "cpu";
    int threads = 0;
    std::uint64_t seed = 1;      ///< of the first trial
    std::string clock = "wall";  ///< or "process": of the processors, for machines with other load
};

inline constexpr double least_covered = 0.93;

/// Renders every scene `trials` times to a target, each after a forecast. Fills `report`; its rows have all trials.
/// True if the stated intervals have the true error in 93 % of the trials of each scene. Throws InputError.
[[nodiscard]] bool run_coverage(const CoverageOptions& options, const BackendSource& source, Report& report);

}  // namespace tandem::bench
