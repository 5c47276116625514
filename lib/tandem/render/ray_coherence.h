/// How alike the rays of a batch are.
#pragma once

#include <cstdint>
#include <span>

#include "tandem/math/aabb.h"
#include "tandem/math/ray.h"

namespace tandem {

/// True if in most groups of 32 consecutive rays the directions are within about 25 degrees of one another and the
/// origins within 1/16 of `reach`, the size of the scene. Inspects up to 64 groups. A guess: only speed may depend on
/// it.
[[nodiscard]] bool are_coherent(std::span<const Ray<float>> rays, float reach);

/// How far apart the first and the last of 16 consecutive rays are at the middle of `bounds`, or half the size of
/// `bounds` away if they start nearer; in metres. The median of up to 64 such packets; 0 for fewer than 16 rays. A
/// guess: only speed may depend on it.
[[nodiscard]] double packet_width(std::span<const Ray<float>> rays, const Aabb& bounds);

/// The number of rays in a row, if the rays seem to be those of the pixels of an image, row by row: then a ray is as
/// similar to the one below it as to the next one. Otherwise 0. The result is a multiple of 8 and divides the number of
/// rays. Compares some of the rays. A guess: only speed may depend on it.
[[nodiscard]] std::uint32_t row_length(std::span<const Ray<float>> rays, float reach);

}  // namespace tandem
