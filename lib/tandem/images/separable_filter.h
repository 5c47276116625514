/// Filters of pictures whose weights are products of one factor along x and one along y.
#pragma once

#include <functional>
#include <vector>

namespace tandem {

/// One number for each pixel, row by row from the top left.
struct Plane {
    int width = 0;
    int height = 0;
    std::vector<double> values;  ///< width * height
};

/// Weights of one axis: an odd count, the middle one for the pixel itself.
using AxisWeights = std::vector<double>;

/// `weight(offset)` for every whole offset from -radius to radius, pixels.
[[nodiscard]] AxisWeights axis_weights(int radius, const std::function<double(double)>& weight);

/// Scaled so that the positive weights sum to 1 and the negative ones, if there are any, to -1.
[[nodiscard]] AxisWeights normalised(AxisWeights weights);

/// The sum over the window of weight times value; beyond a border the pixel at the border is repeated.
[[nodiscard]] Plane filtered(const Plane& plane, const AxisWeights& along_x, const AxisWeights& along_y);

}  // namespace tandem
