/// The paths of the oracle, in extended precision, after the camera ray. They share only the random numbers with
/// lib/tandem/kernel, and so the choices that depend on them.
#pragma once

#include "tandem/film/film_planes.h"
#include "tandem/kernel/camera/camera.h"
#include "tandem/kernel/path_limits.h"
#include "tandem/kernel/sampler/dimensions.h"
#include "tandem/oracle/oracle_vertex.h"

namespace tandem::oracle {

/// The radiance along a camera ray.
[[nodiscard]] Vector trace_path(const BoundedView& scene, const PathLimits& limits, const SampleId<float>& sample,
                                const Line& camera_ray);

/// Adds the first hit of a sample, beyond masked-out surfaces, to the planes of first hits (docs/planes.md).
/// `is_first`: it is the first sample.
void add_first_hit(const BoundedView& scene, const CameraView& camera, const Line& camera_ray, bool is_first,
                   std::size_t pixel, const FilmPlanes& planes);

}  // namespace tandem::oracle
