/// tandem-bench versus: one scene on every backend, phase by phase; or rays per second.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "backend_source.h"
#include "common/arguments.h"
#include "ray_sets.h"
#include "tandem/report/report.h"

namespace tandem::bench {

struct VersusOptions {
    std::string scene = "named:paper";
    std::vector<std::string> backends = {"cpu", "cuda"};
    std::string tier = "strict";
    int threads = 0;  ///< of the CPU; 0 means one per core
    int repetitions = 7;
    // frames
    FilmSize size{1000, 900};
    int samples = 100;
    std::uint64_t seed = 0;
    std::int32_t frame = 0;
    // rays
    std::optional<RaySet> rays;  ///< trace rays instead of rendering
    int ray_edge = 2048;         ///< rays: edge * edge
};

/// Renders the frame (or traces the rays) with every backend, in rounds of alternating order; fills `report`. True if
/// the films (hits) of all backends are equal, or need not be since the tier is fast.
[[nodiscard]] bool run_versus(const VersusOptions& options, const BackendSource& source, Report& report);

/// Rays per second of the backends, and of raw Embree for a scene of spheres; `rows` are in that order.
struct RayTiming {
    std::vector<BenchmarkRow> rows;
    std::size_t hits = 0;            ///< of the first backend
    std::size_t differing_hits = 0;  ///< of the other backends from the first, in id or in a bit of t
    std::size_t native_ids = 0;      ///< hits of raw Embree with another id
    bool has_native = false;         ///< the last row is raw Embree's
};

[[nodiscard]] RayTiming time_rays(const VersusOptions& options, const std::vector<std::string>& backends,
                                  const BackendSource& source, Report& report);

}  // namespace tandem::bench
