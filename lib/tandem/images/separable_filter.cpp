#include "tandem/images/separable_filter.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace tandem {

namespace {

/// Filters `count` values along one axis, `stride` apart, from `first` on.
void filter_line(const double* first, double* result, int count, std::ptrdiff_t stride, const AxisWeights& weights) {
    const int radius = static_cast<int>(weights.size() / 2);
    for (int i = 0; i < count; ++i) {
        double sum = 0;
        for (int offset = -radius; offset <= radius; ++offset) {
            const int from = std::clamp(i + offset, 0, count - 1);
            sum += weights[static_cast<std::uint32_t>(offset + radius)] * first[from * stride];
        }
        result[i * stride] = sum;
    }
}

}  // namespace

AxisWeights axis_weights(int radius, const std::function<double(double)>& weight) {
    AxisWeights weights;
    for (int offset = -radius; offset <= radius; ++offset) weights.push_back(weight(offset));
    return weights;
}

AxisWeights normalised(AxisWeights weights) {
    double positive = 0, negative = 0;
    for (const double weight : weights) (weight > 0 ? positive : negative) += weight;
    for (double& weight : weights) weight /= weight > 0 ? positive : (negative < 0 ? -negative : 1);
    return weights;
}

Plane filtered(const Plane& plane, const AxisWeights& along_x, const AxisWeights& along_y) {
    Plane rows{plane.width, plane.height, std::vector<double>(plane.values.size())};
    Plane result = rows;
    const std::ptrdiff_t width = plane.width;
    for (int y = 0; y < plane.height; ++y) {
        filter_line(plane.values.data() + y * width, rows.values.data() + y * width, plane.width, 1, along_x);
    }
    for (int x = 0; x < plane.width; ++x) {
        filter_line(rows.values.data() + x, result.values.data() + x, plane.height, width, along_y);
    }
    return result;
}

}  // namespace tandem
