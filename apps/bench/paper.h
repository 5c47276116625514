/// tandem-bench paper: the speed-up audit. Measures (paper_ladder.h) and writes the page.
#pragma once

#include "paper_ladder.h"

namespace tandem::bench {

/// Measures, and fills `report`. True if Tandem's CPU and GPU rendered the same films, or if only one of them ran.
[[nodiscard]] bool run_paper(const PaperOptions& options, const BackendSource& source, Report& report);

/// The page of measurements.
void report_paper(PaperMeasurements measurements, const PaperOptions& options, Report& report);

}  // namespace tandem::bench
