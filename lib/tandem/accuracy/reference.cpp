#include "tandem/accuracy/reference.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "tandem/base/error.h"

namespace tandem {

namespace {

bool is_finite(const Vec3f& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check(const FloatImage& image) {
    if (image.pixels.empty() || image.pixels.size() != pixel_count(image)) {
        throw InputError(fmt::format("a reference of {} x {} pixels holds {}: render it again", image.width,
                                     image.height, image.pixels.size()));
    }
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (is_finite(image.pixels[i])) continue;
        const auto width = static_cast<std::size_t>(image.width);
        throw InputError(
            fmt::format("pixel ({}, {}) of a reference is not finite: render it again with another seed or more "
                        "samples",
                        i % width, i / width));
    }
}

}  // namespace

Reference::Reference(FloatImage first, FloatImage second) : first_(std::move(first)), second_(std::move(second)) {
    check(first_);
    check(*second_);
    if (first_.width != second_->width || first_.height != second_->height) {
        throw InputError(fmt::format("two references of one scene need one size, but have {} x {} and {} x {} pixels",
                                     first_.width, first_.height, second_->width, second_->height));
    }
    mean_ = first_;
    for (std::size_t i = 0; i < mean_.pixels.size(); ++i) {
        mean_.pixels[i] = narrow((widen(first_.pixels[i]) + widen(second_->pixels[i])) / 2.0);
    }
}

Reference::Reference(FloatImage truth) : first_(std::move(truth)), mean_(first_) { check(first_); }

double Reference::noise_floor() const {
    if (is_exact()) return 0;
    double squares = 0;
    for (std::size_t i = 0; i < first_.pixels.size(); ++i) {
        const Vec3d difference = widen(first_.pixels[i]) - widen(second_->pixels[i]);
        squares += dot(difference, difference);
    }
    // The variance of a difference is that of both images together
    return std::sqrt(squares / 2 / static_cast<double>(3 * first_.pixels.size()));
}

}  // namespace tandem
