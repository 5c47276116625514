/// How much work a ray of the camera is, and how many samples that leaves.
#pragma once

#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/path_limits.h"

namespace tandem {

/// How many primitives have bounds that a ray of the camera crosses: the mean of 4 x 4 rays over a film of width x
/// height pixels. A hierarchy of boxes cannot spare these tests to a ray that hits nothing. A model of a solid thing
/// has tens, a cloud of large triangles that overlap has a good part of all. Estimated from 2^16 primitives where there
/// are more; the same on every machine.
[[nodiscard]] double bounds_per_ray(const PreparedScene& scene, int width, int height);

/// Up to here a scene gets the samples that are usual. Of 3,352 models found in public repositories none has over 36.
inline constexpr double most_bounds_per_ray = 1'000;

/// As many samples, of `samples` and one at least, as make no more work than those of a scene with most_bounds_per_ray.
[[nodiscard]] int affordable_samples(int samples, double bounds_per_ray);

/// `limits`, or those of short paths (one reflection, one refraction, no diffuse bounce) where even one sample is more
/// work than `samples` in a scene with most_bounds_per_ray.
[[nodiscard]] PathLimits affordable_limits(const PathLimits& limits, int samples, double bounds_per_ray);

}  // namespace tandem
