#include "tandem/images/separable_filter.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace tandem {

namespace {

/// Adds `count` values from `from` on, times the weight. A loop that g++ turns into vector instructions.
void add_weighted(const double* from, double weight, int count, double* to) {
    for (int i = 0; i < count; ++i) to[i] += weight * from[i];
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

// Each value is the sum of its neighbours in their order, whatever the order of the loops.
Plane filtered(const Plane& plane, const AxisWeights& along_x, const AxisWeights& along_y) {
    Plane rows{plane.width, plane.height, std::vector<double>(plane.values.size())};
    Plane result = rows;
    const auto row = [&](auto& of, int y) { return of.values.data() + static_cast<std::ptrdiff_t>(y) * plane.width; };
    const auto radius_x = static_cast<std::ptrdiff_t>(along_x.size() / 2);
    const int radius_y = static_cast<int>(along_y.size() / 2);
    std::vector<double> padded;
    for (int y = 0; y < plane.height; ++y) {
        const double* first = row(plane, y);
        const auto edge = static_cast<std::size_t>(radius_x);
        padded.assign(edge, first[0]);
        padded.insert(padded.end(), first, first + plane.width);
        padded.insert(padded.end(), edge, first[plane.width - 1]);
        for (std::size_t i = 0; i < along_x.size(); ++i) {
            add_weighted(padded.data() + i, along_x[i], plane.width, row(rows, y));
        }
    }
    for (int y = 0; y < plane.height; ++y) {
        for (int offset = -radius_y; offset <= radius_y; ++offset) {
            const double* from = row(rows, std::clamp(y + offset, 0, plane.height - 1));
            add_weighted(from, along_y[static_cast<std::size_t>(offset + radius_y)], plane.width, row(result, y));
        }
    }
    return result;
}

}  // namespace tandem
