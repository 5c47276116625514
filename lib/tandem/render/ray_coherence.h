/// How alike the rays of a batch are.
#pragma once

#include <cstdint>
#include <span>

#include "tandem/math/ray.h"

namespace tandem {

/// True if in most groups of 32 consecutive rays the directions are within about 25 degrees of one another and the
/// origins within 1/16 of `reach`, the size of the scene. Inspects up to 64 groups. A guess: only speed may depend on
/// it.
[[nodiscard]] bool are_coherent(std::span<const Ray<float>> rays, float reach);

/// The rays of a row, if the rays seem to be those of the pixels of an image, row by row, so that a ray is as like the
/// one below it as the next one; else 0. A multiple of 8, of which the number of rays is a multiple. Compares some
/// rays. A guess: only speed may depend on it.
[[nodiscard]] std::uint32_t row_length(std::span<const Ray<float>> rays, float reach);

}  // namespace tandem
