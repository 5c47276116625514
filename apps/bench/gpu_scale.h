/// How the time of a frame falls with the number of GPUs that render it together.
#pragma once

#include <string>
#include <vector>

#include "backend_source.h"
#include "common/arguments.h"
#include "tandem/report/report.h"

namespace tandem::bench {

struct GpuScaleOptions {
    std::string scene;
    std::vector<int> gpus;  ///< the numbers of GPUs to measure; 1 is measured in any case
    FilmSize size{3840, 2160};
    int samples = 64;
    std::string tier = "strict";
    int repetitions = 7;
};

/// One number of GPUs.
struct GpuScaleStep {
    int gpus = 1;
    BenchmarkRow row;      ///< wall-clock times from the loaded scene to the film in host memory
    Ratio efficiency;      ///< the time of one GPU over this time and the number of GPUs
    std::string shares{};  ///< of the GPUs in the samples: "GPU 0 50.1 %, GPU 1 49.9 %"
};

struct GpuScale {
    std::vector<GpuScaleStep> steps;  ///< in the order of the numbers of GPUs
    BenchmarkRow in_bands;            ///< one GPU that renders in bands, as several do
    bool are_equal = true;            ///< all films have the same hash
};

/// Times a frame on each number of GPUs, in turns, after two rounds of warm-up. One GPU renders it at once, as by
/// default, and in bands, so that the download of one band overlaps the rendering of the next; the faster of the two
/// counts as the time of one GPU.
[[nodiscard]] GpuScale time_gpus(const GpuScaleOptions& options, const BackendSource& source, Report& report);

/// Measures the frames of the scenes, and adds rows, a table and plots to the report. True if all films are equal, or
/// need not be since the tier is fast.
[[nodiscard]] bool run_gpu_scale(GpuScaleOptions options, const std::vector<std::string>& scenes,
                                 const BackendSource& source, Report& report);

}  // namespace tandem::bench
