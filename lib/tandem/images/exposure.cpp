#include "tandem/images/exposure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "tandem/images/display.h"
#include "tandem/math/exact_math.h"
#include "tandem/math/fp_environment.h"
#include "tandem/math/srgb.h"

namespace tandem {

namespace {

constexpr double middle_grey = 0.18;
constexpr double white = 1;

double log2_wide(double x) { return log_wide<float>(x) / log_wide<float>(2.0); }

/// The luminances of the pixels that count, in ascending order.
std::vector<float> sorted_luminances(const FloatImage& image) {
    std::vector<float> luminances;
    luminances.reserve(image.pixels.size());
    for (const Vec3f& pixel : image.pixels) {
        const float y = narrow(luminance(widen(pixel)));  // not finite if any channel is not
        if (y >= std::numeric_limits<float>::min() && std::isfinite(y)) luminances.push_back(y);
    }
    std::sort(luminances.begin(), luminances.end());
    return luminances;
}

}  // namespace

double auto_exposure(const FloatImage& image) {
    const DefaultFpEnvironment guard;
    const std::vector<float> luminances = sorted_luminances(image);
    const std::size_t count = luminances.size();
    if (count == 0) return 0;
    const std::size_t tail = count / 10;
    double sum = 0;
    for (const float y : std::span(luminances).subspan(tail, count - 2 * tail)) sum += log2_wide(widen(y));
    const double mean = sum / static_cast<double>(count - 2 * tail);
    const double bright = log2_wide(widen(luminances[count - 1 - count / 20]));
    const double stops = std::min(log2_wide(middle_grey) - mean, log2_wide(white) - bright);
    const double tenths = std::round(10 * stops) + 0.0;  // no negative zero
    return std::clamp(tenths / 10, -most_exposure_stops, most_exposure_stops);
}

}  // namespace tandem
