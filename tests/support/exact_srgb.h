/// The transfer function of sRGB in 400 decimal digits, from the definition (IEC 61966-2-1). Shares nothing with lib.
#pragma once

#include "support/exact_geometry.h"

namespace tandem::test {

/// The linear value of the sRGB value c.
inline Big exact_linear_of_srgb(const Big& c) {
    if (c <= Big("0.04045")) return c / Big("12.92");
    return pow((c + Big("0.055")) / Big("1.055"), Big("2.4"));
}

}  // namespace tandem::test
