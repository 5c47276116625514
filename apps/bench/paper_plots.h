/// The plots of tandem-bench paper, after the figures of the paper.
#pragma once

#include "paper_ladder.h"

namespace tandem::bench {

/// Time per frame: CPU, GPU, both.
void add_time_plots(const PaperMeasurements& measurements, Report& report);

/// Samples per second of every row.
void add_throughput_plot(PaperRows& rows, Report& report);

/// Residual per frame at two tolerances.
void add_residual_plots(const PaperMeasurements& measurements, Report& report);

}  // namespace tandem::bench
