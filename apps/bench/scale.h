/// tandem-bench scale: how times grow with the number of primitives, and fall with the number of threads and GPUs.
#pragma once

#include <string>
#include <vector>

#include "backend_source.h"
#include "common/arguments.h"
#include "tandem/report/report.h"

namespace tandem::bench {

struct ScaleOptions {
    std::vector<std::string> parts = {"rays"};  ///< rays, frames (gpu_scale.h), instances (instance_rates.h)
    std::vector<std::string> kinds = {"spheres", "boxes", "triangles"};  ///< of named scenes, named:KIND/N
    double least = 10, most = 1e6;                                       ///< primitives
    int steps = 1;                                                       ///< numbers of primitives per factor of ten
    std::vector<std::string> rays = {"coherent", "random", "bounce", "shadow"};
    std::vector<std::string> backends = {"cpu", "cuda"};
    std::vector<int> threads = {0};  ///< of the CPU, each measured; 0 is one per core
    std::vector<int> gpus = {1};     ///< numbers of GPUs, each measured; 0 stands for 1, 2 and so on to all
    std::string tier = "strict";
    int ray_edge = 1024;  ///< rays: edge * edge
    int repetitions = 3;
    std::vector<std::string> scenes = {"named:paper", "named:spheres/1000000"};  ///< of frames
    FilmSize size{3840, 2160};
    int samples = 64;
};

/// The numbers of GPUs to measure on this machine, ascending. Throws InputError for negative ones.
[[nodiscard]] std::vector<int> numbers_of_gpus(const std::vector<int>& wanted, const BackendSource& source);

/// The exponent e of time ~ n^e by least squares of the logarithms, over at least two points with different n.
[[nodiscard]] double fitted_exponent(const std::vector<Point>& times);

/// How much faster than log n the times grow: the most of time(n) / time(first) over log n / log(first), with n > 1.
[[nodiscard]] double growth_over_log(const std::vector<Point>& times);

/// Builds and traces scenes of growing size; fills `report`. True if the hits of all backends are equal, or need not be
/// since the tier is fast. Throws InputError for unknown kinds or rays, and EnvironmentError for GPUs that do not
/// exist.
[[nodiscard]] bool run_scale(const ScaleOptions& options, const BackendSource& source, Report& report);

}  // namespace tandem::bench
