/// The oracle's own paths, in extended precision. What it shares with lib/integrator is the random numbers, and so the
/// choices that hang on them.
#pragma once

#include "tandem/geometry/ray_source.h"
#include "tandem/integrator/path_limits.h"
#include "tandem/oracle/oracle_geometry.h"
#include "tandem/sampler/dimensions.h"

namespace tandem::oracle {

struct NearestSurface {
    SurfaceHit surface{};
    std::uint32_t primitive = no_primitive;
};

/// In front of a line that comes from `source`; ties go to the lower id. Hits on `except` do not count.
[[nodiscard]] NearestSurface nearest_surface(const SceneView& scene, const Line& line, const RaySource& source,
                                             std::uint32_t except = no_primitive);

/// Radiance along a camera ray.
[[nodiscard]] Vector trace_path(const SceneView& scene, const PathLimits& limits, const SampleId<float>& sample,
                                const Line& camera_ray);

}  // namespace tandem::oracle
