/// Estimates the cost of camera rays, and how many samples are affordable.
#pragma once

#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/path_limits.h"

namespace tandem {

/// The number of primitives whose bounds a camera ray crosses: the mean of 4 x 4 rays over a film of width x height
/// pixels. No BVH can avoid these tests for a ray that hits nothing. In an ordinary model there are tens; in a cloud of
/// large overlapping triangles, a large part of all. Estimated from 2^16 primitives if there are more; the same on
/// every machine.
[[nodiscard]] double bounds_per_ray(const PreparedScene& scene, int width, int height);

/// Up to this value a scene gets the usual number of samples. Of 3,352 models found in public repositories none has
/// more than 36.
inline constexpr double most_bounds_per_ray = 1'000;

/// The number of samples, at most `samples` and at least one, that cost no more than `samples` in a scene with
/// most_bounds_per_ray.
[[nodiscard]] int affordable_samples(int samples, double bounds_per_ray);

/// `limits`, or those of short paths (one reflection, one refraction, no diffuse bounce) if even one sample costs more
/// than `samples` in a scene with most_bounds_per_ray.
[[nodiscard]] PathLimits affordable_limits(const PathLimits& limits, int samples, double bounds_per_ray);

}  // namespace tandem
