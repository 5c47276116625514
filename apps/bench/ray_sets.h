/// Sets of rays to trace: coherent ones of a camera, and random ones through the scene.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tandem/kernel/shapes/hit.h"
#include "tandem/math/ray.h"

namespace tandem::bench {

enum class RaySet { coherent, random };

/// "coherent" or "random". Throws InputError.
[[nodiscard]] RaySet parse_ray_set(const std::string& name);
[[nodiscard]] std::string to_string(RaySet set);

/// edge * edge rays, for scenes within [-1, 1]^3.
/// coherent: through the centres of the pixels of a square pinhole view from (0, 0, 3.2) along -z, half angle
/// atan(1 / 1.5), row by row. random: origins uniform in the cube, directions uniform over the sphere, unit length.
/// The same on every machine.
[[nodiscard]] std::vector<Ray<float>> make_rays(RaySet set, int edge);

/// Uniform in [-1, 1)^3: number `draw` of item `index` of a stream.
[[nodiscard]] Vec3d uniform_in_cube(std::uint32_t stream, std::uint32_t index, std::uint32_t draw);

/// The same primitive, and the same bits of t.
[[nodiscard]] bool has_bits_of(const Hit& a, const Hit& b);

}  // namespace tandem::bench
