/// Whether neighbouring rays of a batch have nearly the same origins and directions.
#pragma once

#include <span>

#include "tandem/math/ray.h"

namespace tandem {

/// True if in most groups of 32 consecutive rays the directions are within about 25 degrees of one another and the
/// origins within 1/16 of `reach`, the size of the scene. Inspects up to 64 groups. A guess: only speed may depend on
/// it.
[[nodiscard]] bool are_coherent(std::span<const Ray<float>> rays, float reach);

}  // namespace tandem
