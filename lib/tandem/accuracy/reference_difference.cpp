#include "tandem/accuracy/reference_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tandem/base/error.h"

namespace tandem {

ErrorEstimate difference_of(const Reference& a, const Reference& b) {
    if (a.width() != b.width() || a.height() != b.height()) {
        throw InputError(fmt::format("references that are compared need one size, but have {} x {} and {} x {} pixels",
                                     a.width(), a.height(), b.width(), b.height()));
    }
    constexpr double of_95_percent = 1.96;  // of a normal deviate
    double products = 0, variance = 0;
    const std::size_t pixels = a.first().pixels.size();
    for (std::size_t i = 0; i < pixels; ++i) {
        const Vec3d first = widen(a.first().pixels[i]) - widen(b.first().pixels[i]);
        const Vec3d second = widen(a.second().pixels[i]) - widen(b.second().pixels[i]);
        products += dot(first, second);
        const double deviation = dot((first + second) / 2.0, first - second);
        variance += deviation * deviation;
    }
    const auto values = static_cast<double>(3 * pixels);
    const double square = products / values, margin = of_95_percent * std::sqrt(variance) / values;
    const bool resolved = square > margin;
    return root_of({square, {resolved ? square - margin : 0, std::max(square, 0.0) + margin}, resolved});
}

}  // namespace tandem
