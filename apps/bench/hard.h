/// tandem-bench hard: the corpus of hard cases on any backend and tier, and the answers of other renderers.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "backend_source.h"
#include "tandem/report/report.h"

namespace tandem::bench {

struct HardOptions {
    std::vector<std::string> cases;  ///< "A1", "B*"; empty means all
    std::vector<std::string> backends = {"cpu", "cuda"};
    std::vector<std::string> tiers;  ///< empty means all
    std::size_t rays = 50'000;       ///< per case
    std::string export_folder;       ///< write the ray cases there and run nothing
    std::string answers;             ///< score another renderer's answers, and run nothing
};

/// Runs, exports or checks the cases, and fills `report`. True if every error bound of
/// tests/hard/corpus/error_bounds.def was kept; other renderers' answers are checked against those of strict. Throws
/// EnvironmentError in a build without the corpus, which needs MPFR.
[[nodiscard]] bool run_hard(const HardOptions& options, const BackendSource& source, Report& report);

}  // namespace tandem::bench
