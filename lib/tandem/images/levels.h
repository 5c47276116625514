/// The linear values of the levels of 8-bit texels.
#pragma once

#include <vector>

namespace tandem {

/// 256 linear values of sRGB levels, then 256 of linear ones (TextureSet::levels), each rounded once to float.
///
/// sRGB: linear_of_srgb(level / 255). The same bits on every machine.
[[nodiscard]] std::vector<float> texture_levels();

}  // namespace tandem
