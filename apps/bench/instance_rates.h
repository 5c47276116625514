/// tandem-bench scale --parts instances: rays through meshes that are kept once (docs/instances.md).
#pragma once

#include <string>
#include <vector>

#include "backend_source.h"
#include "ray_sets.h"
#include "tandem/report/report.h"

namespace tandem::bench {

struct InstanceRateOptions {
    int block = 125;      ///< instances of named:block/N
    int city_edge = 317;  ///< those of named:city/N along its edge
    int ray_edge = 2048;  ///< rays: edge * edge
    int repetitions = 7;
};

/// Rays in named:city/N: a view over it at flat angles, 0.6 to 17 degrees below the horizon, from low above its edge;
/// or rays that start among its instances.
[[nodiscard]] std::vector<Ray<float>> city_rays(RaySet set, int city_edge, int ray_edge);

/// On a GPU, in turns: rays in a block of instances whose faces are written out, in the same block kept once, and in a
/// city of them kept once.
struct InstanceRates {
    BenchmarkRow written, kept, city;
    std::size_t differing_hits;  ///< of the block kept once from the same written out, in id or in a bit of t
};
[[nodiscard]] InstanceRates time_instances(RaySet set, const InstanceRateOptions& options, const BackendSource& source,
                                           Report& report);

/// All sets of rays. True if no hit differs.
[[nodiscard]] bool run_instance_rates(const InstanceRateOptions& options, const BackendSource& source, Report& report);

}  // namespace tandem::bench
