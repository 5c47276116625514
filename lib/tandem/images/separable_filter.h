/// Separable filters: weights are products of one factor along x and one along y.
#pragma once

#include <functional>
#include <vector>

namespace tandem {

/// One number per pixel, row by row from the top left.
struct Plane {
    int width = 0;
    int height = 0;
    std::vector<double> values;  ///< width * height
};

/// The weights of one axis: an odd number, the middle one for the pixel itself.
using AxisWeights = std::vector<double>;

/// `weight(offset)` for every integer offset from -radius to radius, in pixels.
[[nodiscard]] AxisWeights axis_weights(int radius, const std::function<double(double)>& weight);

/// Scaled so that the positive weights sum to 1 and the negative ones, if there are any, to -1.
[[nodiscard]] AxisWeights normalised(AxisWeights weights);

/// Filters an image; beyond its borders the border pixels are repeated.
[[nodiscard]] Plane filtered(const Plane& plane, const AxisWeights& along_x, const AxisWeights& along_y);

}  // namespace tandem
