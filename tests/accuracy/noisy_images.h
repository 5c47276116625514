/// Images with noise of known variance.
#pragma once

#include <cmath>
#include <numbers>

#include "support/random.h"
#include "tandem/images/image.h"

namespace tandem::test {

[[nodiscard]] inline FloatImage constant_image(int width, int height, const Vec3f& value) {
    FloatImage image{width, height, {}};
    image.pixels.assign(pixel_count(image), value);
    return image;
}

/// A normal deviate, by the method of Box and Muller.
[[nodiscard]] inline double normal(Random& random) {
    const double radius = std::sqrt(-2 * std::log(random.uniform(0x1p-60, 1.0)));
    return radius * std::cos(random.uniform(0.0, 2 * std::numbers::pi));
}

/// Grey pixels around `mean`, with normal noise: the channels of a pixel are equal.
[[nodiscard]] inline FloatImage noisy_image(Random& random, int width, int height, double mean, double noise) {
    FloatImage image{width, height, {}};
    for (int i = 0; i < width * height; ++i) {
        const auto value = static_cast<float>(mean + noise * normal(random));
        image.pixels.push_back({value, value, value});
    }
    return image;
}

}  // namespace tandem::test
