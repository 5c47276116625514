/// What the levels of 8-bit texels stand for.
#pragma once

#include <vector>

namespace tandem {

/// 256 linear values of sRGB levels, then 256 of linear ones (TextureSet::levels), each rounded once to float.
///
/// sRGB: c / 12.92 up to c = 0.04045, else ((c + 0.055) / 1.055)^2.4, c = level / 255. Source: IEC 61966-2-1:1999. The
/// same bits on every machine.
[[nodiscard]] std::vector<float> texture_levels();

}  // namespace tandem
