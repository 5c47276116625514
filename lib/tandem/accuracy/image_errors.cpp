#include "tandem/accuracy/image_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "tandem/base/error.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

double sum(const Vec3d& v) { return v.x + v.y + v.z; }

Vec3d product(const Vec3d& a, const Vec3d& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

/// 1 / (r^2 + e) of every channel. An image without light has no relative error: the weights are 1.
std::vector<Vec3d> relative_weights(const FloatImage& mean) {
    double total = 0;
    for (const Vec3f& pixel : mean.pixels) total += sum(widen(pixel));
    const double average = total / static_cast<double>(3 * mean.pixels.size());
    const double floor = average == 0 ? 1 : 0.01 * average * average;
    std::vector<Vec3d> weights;
    weights.reserve(mean.pixels.size());
    for (const Vec3f& pixel : mean.pixels) {
        const Vec3d squares = product(widen(pixel), widen(pixel));
        weights.push_back({1 / (squares.x + floor), 1 / (squares.y + floor), 1 / (squares.z + floor)});
    }
    return weights;
}

/// The relative errors of pixels by size, so that the largest can be left out.
struct PixelError {
    double size;   ///< of the squared difference from the mean reference, by which pixels are chosen
    double value;  ///< the estimate that is averaged
};

double trimmed_sum(std::vector<PixelError>& errors, std::size_t left_out) {
    const auto kept = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() - left_out);
    std::nth_element(errors.begin(), kept, errors.end(),
                     [](const PixelError& a, const PixelError& b) { return a.size < b.size; });
    double total = 0;
    for (auto at = errors.begin(); at != kept; ++at) total += at->value;
    return total;
}

}  // namespace

ErrorMeter::ErrorMeter(const Reference& reference)
    : reference_(reference), weights_(relative_weights(reference.mean())), sums_(reference.mean().pixels.size()) {}

ImageErrors ErrorMeter::add(const FloatImage& image) {
    const DefaultFpEnvironment guard;
    if (image.width != reference_.width() || image.height != reference_.height() ||
        image.pixels.size() != sums_.size()) {
        throw InputError(fmt::format("an image of {} x {} pixels cannot be compared with a reference of {} x {}",
                                     image.width, image.height, reference_.width(), reference_.height()));
    }
    ImageErrors errors;
    std::vector<PixelError> relative;
    relative.reserve(sums_.size());
    for (std::size_t i = 0; i < sums_.size(); ++i) {
        const Vec3d mean = widen(reference_.mean().pixels[i]);
        const Vec3d x = widen(image.pixels[i]);
        if (!std::isfinite(sum(x))) {
            ++errors.broken;
            sums_[i] = sums_[i] + mean;
            continue;
        }
        sums_[i] = sums_[i] + x;
        const Vec3d estimate =
            product(x - widen(reference_.first().pixels[i]), x - widen(reference_.second().pixels[i]));
        const double value = dot(estimate, weights_[i]);
        errors.squared += sum(estimate);
        errors.relative += value;
        relative.push_back({dot(product(x - mean, x - mean), weights_[i]), value});
    }
    ++count_;
    const auto channels = [](std::size_t pixels) { return static_cast<double>(3 * std::max<std::size_t>(pixels, 1)); };
    const std::size_t left_out = std::min(
        relative.size(), static_cast<std::size_t>(std::ceil(trimmed_share * static_cast<double>(sums_.size()))));
    errors.squared /= channels(relative.size());
    errors.relative /= channels(relative.size());
    errors.trimmed = trimmed_sum(relative, left_out) / channels(relative.size() - left_out);
    return errors;
}

ErrorMeter::Variance ErrorMeter::reference_variance() const {
    const DefaultFpEnvironment guard;
    if (reference_.is_exact() || count_ == 0) return {};
    Variance variance;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
        const Vec3d bias = sums_[i] / static_cast<double>(count_) - widen(reference_.mean().pixels[i]);
        const Vec3d noise = widen(reference_.first().pixels[i]) - widen(reference_.second().pixels[i]);
        const double plain = dot(bias, noise);
        const double weighted = dot(product(bias, noise), weights_[i]);
        variance.squared += plain * plain;
        variance.relative += weighted * weighted;
    }
    const double channels = static_cast<double>(3 * sums_.size());
    variance.squared /= channels * channels;
    variance.relative /= channels * channels;
    return variance;
}

FloatImage ErrorMeter::mean_image() const {
    FloatImage image{reference_.width(), reference_.height(), {}};
    image.pixels.reserve(sums_.size());
    for (const Vec3d& pixel : sums_) {
        image.pixels.push_back(narrow(pixel / static_cast<double>(std::max<std::size_t>(count_, 1))));
    }
    return image;
}

}  // namespace tandem
