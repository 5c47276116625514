/// Small images, and their comparison.
#pragma once

#include <string>

#include "hard/corpus/hard_case.h"

namespace tandem::hard {

/// 61 x 47 pixels, three samples each: odd, so that tiles and packets end in the middle.
[[nodiscard]] RenderJob small_picture(const Subject& subject);

/// Renders a film, and adds its time and NaN to `score`.
[[nodiscard]] Film picture_of(Backend& backend, const PreparedScene& scene, const RenderJob& job, Score& score);

/// Every pixel of the two, bit by bit.
void compare_bits(const Film& film, const Film& right, const std::string& what, Score& score);

}  // namespace tandem::hard
