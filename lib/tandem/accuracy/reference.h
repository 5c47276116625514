/// The references that the errors of an image are measured against.
#pragma once

#include <optional>

#include "tandem/images/image.h"

namespace tandem {

/// Two images of one truth, rendered independently (with other seeds), or the truth itself. With two of them the
/// product of the differences from both is an estimate of the squared error without bias, whatever noise they have: the
/// noise of one is independent of that of the other and of the image.
class Reference {
  public:
    /// Two independent images. Throws InputError unless both have the same size, not zero, and finite values.
    Reference(FloatImage first, FloatImage second);
    /// The truth, from a closed form.
    explicit Reference(FloatImage truth);

    [[nodiscard]] int width() const { return first_.width; }
    [[nodiscard]] int height() const { return first_.height; }
    [[nodiscard]] bool is_exact() const { return !second_; }
    [[nodiscard]] const FloatImage& first() const { return first_; }
    /// The same as first() if the reference is exact.
    [[nodiscard]] const FloatImage& second() const { return second_ ? *second_ : first_; }
    /// The best estimate of the truth: the mean of both.
    [[nodiscard]] const FloatImage& mean() const { return mean_; }
    /// The RMSE of each of the two images, from their difference: an error measured against only one of them could not
    /// fall below it. 0 if the reference is exact.
    [[nodiscard]] double noise_floor() const;

  private:
    FloatImage first_;
    std::optional<FloatImage> second_;
    FloatImage mean_;
};

}  // namespace tandem
