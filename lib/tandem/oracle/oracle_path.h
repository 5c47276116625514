/// The oracle's own paths, in extended precision. What it shares with lib/tandem/kernel is the random numbers, and
/// so the choices that depend on them.
#pragma once

#include "tandem/film/film_planes.h"
#include "tandem/kernel/camera/camera.h"
#include "tandem/kernel/path_limits.h"
#include "tandem/kernel/sampler/dimensions.h"
#include "tandem/kernel/shapes/ray_source.h"
#include "tandem/oracle/oracle_geometry.h"

namespace tandem::oracle {

struct NearestSurface {
    SurfaceHit surface{};
    std::uint32_t primitive = no_primitive;
};

/// Up to where a path has passed all hits, in their order: by t, then by id.
struct Passed {
    Real t = 0;
    std::uint32_t primitive = no_primitive;
};

/// In front of a line that comes from `source`; ties go to the lower id. Hits on `except` do not count. For the ray of a
/// path, with `passed`, hits count beyond that, and culled faces are not hit from behind.
[[nodiscard]] NearestSurface nearest_surface(const SceneView& scene, const Line& line, const RaySource& source,
                                             std::uint32_t except = no_primitive, const Passed* passed = nullptr);

/// Radiance along a camera ray.
[[nodiscard]] Vector trace_path(const SceneView& scene, const PathLimits& limits, const SampleId<float>& sample,
                                const Line& camera_ray);

/// Adds to the planes that tell of first hits what a sample of a pixel hits first, behind holes (docs/planes.md).
/// `is_first`: it is the first sample.
void add_first_hit(const SceneView& scene, const CameraView& camera, const Line& camera_ray, bool is_first,
                   std::size_t pixel, const FilmPlanes& planes);

}  // namespace tandem::oracle
