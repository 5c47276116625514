#include "tandem/images/separable_filter.h"

#include <algorithm>
#include <cstddef>

namespace tandem {

namespace {

/// The weighted sums of `size` neighbouring values of the lines, in the order of the lines, from place `at` on. The
/// sums stay in registers; g++ turns the inner loop into vector instructions.
template <int size, class Line>
void add_lines(const AxisWeights& weights, const Line& line, int at, double* to) {
    double sums[size] = {};
    for (std::size_t k = 0; k < weights.size(); ++k) {
        const double* from = line(k) + at;
        for (int i = 0; i < size; ++i) sums[i] += weights[k] * from[i];
    }
    for (int i = 0; i < size; ++i) to[at + i] = sums[i];
}

/// The sums over all lines for `count` places; line(k) begins the line of weight k.
template <class Line>
void add_lines(const AxisWeights& weights, const Line& line, int count, double* to) {
    constexpr int block = 16;
    int at = 0;
    for (; at + block <= count; at += block) add_lines<block>(weights, line, at, to);
    for (; at < count; ++at) add_lines<1>(weights, line, at, to);
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
        add_lines(
            along_x, [&](std::size_t k) { return padded.data() + k; }, plane.width, row(rows, y));
    }
    for (int y = 0; y < plane.height; ++y) {
        const auto line = [&](std::size_t k) {
            return row(rows, std::clamp(y + static_cast<int>(k) - radius_y, 0, plane.height - 1));
        };
        add_lines(along_y, line, plane.width, row(result, y));
    }
    return result;
}

}  // namespace tandem
