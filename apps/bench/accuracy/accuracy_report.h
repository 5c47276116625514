/// tandem-bench accuracy: what one more digit costs, and what to choose.
#pragma once

#include "accuracy/sweep.h"

namespace tandem::bench {

/// Sweeps the scenes and fills `report`: the answer in words, and for each scene plots, tables and pictures. With
/// `rebuild_references` it only renders the references again. False if a backend that promises equal bits gives other
/// ones for the baseline than the first backend. Throws InputError for options that make no sense.
[[nodiscard]] bool run_sweep(const SweepOptions& options, const BackendSource& source, Report& report);

}  // namespace tandem::bench
