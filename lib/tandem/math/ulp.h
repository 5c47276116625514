/// Errors in float ulps.
#pragma once

#include <cmath>
#include <limits>

namespace tandem {

/// The unit for errors of results near `exact`: the distance from |exact| to the next float away from zero. For
/// subnormal results it is the smallest float.
[[nodiscard]] inline double float_ulp(double exact) {
    const auto nearest = static_cast<float>(std::abs(exact));
    if (nearest >= std::numeric_limits<float>::max()) return 0x1p104;
    return static_cast<double>(std::nextafter(nearest, HUGE_VALF)) - static_cast<double>(nearest);
}

/// |value - exact| in ulps: at most 0.5 for a correctly rounded result. Infinite if one of them is not finite.
[[nodiscard]] inline double error_in_ulp(float value, double exact) {
    if (!std::isfinite(value) || !std::isfinite(exact)) return HUGE_VAL;
    return std::abs(static_cast<double>(value) - exact) / float_ulp(exact);
}

}  // namespace tandem
