/// One row of a benchmark: one thing, measured several times, with everything needed to interpret the number.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tandem/effects/effects.h"
#include "tandem/render/stats.h"
#include "tandem/report/statistics.h"

namespace tandem {

/// Seconds of one phase of the work, one value per measurement of the row.
struct PhaseTimings {
    std::string name;  ///< "render", "download", ...
    std::vector<double> seconds;
};

/// Share of pixels (or rays) that differ from a reference by more than a tolerance.
struct ErrorFigure {
    std::string against;    ///< "oracle", "cpu", ...
    std::string tolerance;  ///< in words: "any bit", "5 %"
    double share = 0;
};

/// How many times faster than another row of the same report.
struct Factor {
    std::string over;  ///< label of the other row
    Ratio ratio;       ///< its time over that of this row; above 1 if this row is faster
};

struct BenchmarkRow {
    std::string label;
    std::string scene;
    std::string backend;
    std::string variant;  ///< which compiled code ran
    std::string tier;     ///< empty for other programs
    int threads = 0;      ///< 0 where it does not apply
    EffectMask effects;   ///< simulated
    EffectMask carried;   ///< beyond those, contained in the code but unused

    std::vector<double> seconds;       ///< the time of the row, one value per measurement
    std::vector<std::int32_t> rounds;  ///< the round (frame) of each measurement
    std::vector<PhaseTimings> phases;  ///< its parts, and what is not included (build, upload)
    double samples = 0;                ///< pixel samples per measurement; 0 where it does not apply
    double rays = 0;                   ///< rays per measurement; 0 if not known
    std::optional<Factor> factor;
    std::vector<ErrorFigure> errors;
    std::vector<std::pair<std::string, double>> figures;              ///< other results, by name: "mean FLIP"
    std::vector<std::pair<std::string, std::vector<double>>> series;  ///< results with one value per measurement
    RenderCounters counters;                                          ///< summed over the measurements
    int registers = 0;                                                ///< of the kernel; 0 if not known
    double occupancy = 0;                                             ///< 0 if not known
    std::string note;
};

/// From the median time; 0 if the row has no samples or was not measured.
[[nodiscard]] double samples_per_second(const BenchmarkRow& row);
[[nodiscard]] double rays_per_second(const BenchmarkRow& row);

/// The factor of `row` over `baseline`, from the rounds in which both were measured; empty if there are none.
[[nodiscard]] std::optional<Factor> factor_over(const BenchmarkRow& baseline, const BenchmarkRow& row);

/// The timings of the phase; adds the phase if the row does not have it.
[[nodiscard]] PhaseTimings& phase(BenchmarkRow& row, const std::string& name);

}  // namespace tandem
