/// Plots and tables of the accuracy report.
#pragma once

#include <vector>

#include "accuracy/sweep.h"
#include "tandem/report/report.h"

namespace tandem::bench {

/// For every point of a sweep the index of the point of the same backend that dominates it in a metric. Points of
/// other images than the baseline's (has_the_image_of_the_baseline()) neither dominate nor are dominated.
[[nodiscard]] std::vector<std::optional<std::size_t>> dominating_points(const SceneSweep& sweep, Metric metric);

/// Error against time, all backends on the same axes.
[[nodiscard]] ScatterPlot pareto_plot(const SceneSweep& sweep, const std::vector<SweepBackend>& backends,
                                      Metric metric);

/// Every point, with its number in the plots.
[[nodiscard]] Table points_table(const SceneSweep& sweep);

/// The phases of every point.
[[nodiscard]] Table phases_table(const SceneSweep& sweep);

/// What each backend reaches in the time of each point of the first backend's baseline.
[[nodiscard]] Table equal_time_table(const SceneSweep& sweep, const std::vector<SweepBackend>& backends);

/// How soon each backend reaches the error of each point of the first backend's baseline.
[[nodiscard]] Table equal_error_table(const SceneSweep& sweep, const std::vector<SweepBackend>& backends);

/// The settings side by side, each with the samples that fit into the same time.
[[nodiscard]] PictureComparison equal_time_pictures(const SweepOptions& options, const SceneSweep& sweep,
                                                    const std::vector<SweepBackend>& backends);

/// How the error of every sampler falls with the samples.
[[nodiscard]] Table convergence_table(const SceneSweep& sweep, const std::vector<SweepBackend>& backends);

/// The fixed list of scenes.
[[nodiscard]] Table scene_table();

}  // namespace tandem::bench
