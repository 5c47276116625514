/// The filters of the picture from their definitions.
#pragma once

#include <cmath>

#include "tandem/kernel/sampler/pixel_filter.h"
#include "tandem/math/turns.h"

namespace tandem::test {

[[nodiscard]] inline double radius_of(PixelFilter filter) { return reach_of(filter) + 0.5; }

/// The integral of a filter's function of one coordinate from 0 to x >= 0, in pixels from the middle.
[[nodiscard]] inline double integral_of(PixelFilter filter, double x) {
    const double radius = radius_of(filter);
    switch (filter) {
        case PixelFilter::box:
            return x;
        case PixelFilter::tent:
            return x - x * x / 2;
        case PixelFilter::gaussian:
            return std::sqrt(pi / 8) * std::erf(x * std::sqrt(2.0)) - std::exp(-2 * radius * radius) * x;
        case PixelFilter::blackman_harris: {
            const auto wave = [&](int k) { return radius / (k * pi) * std::sin(k * pi * x / radius); };
            return 0.35875 * x + 0.48829 * wave(1) + 0.14128 * wave(2) + 0.01168 * wave(3);
        }
    }
    return 0;
}

/// The share of a filter's weight at offsets below x, in pixels from the middle.
[[nodiscard]] inline double weight_below(PixelFilter filter, double x) {
    const double radius = radius_of(filter);
    const double share = integral_of(filter, std::fmin(std::fabs(x), radius)) / integral_of(filter, radius);
    return x < 0 ? 0.5 - share / 2 : 0.5 + share / 2;
}

}  // namespace tandem::test
