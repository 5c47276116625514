/// Errors of images against a reference.
#pragma once

#include <cstddef>
#include <vector>

#include "tandem/accuracy/reference.h"
#include "tandem/images/image.h"
#include "tandem/math/vec.h"

namespace tandem {

/// The errors of one image, squared: means over all pixels and channels of linear RGB. Estimates without bias can be
/// negative where the error is below the noise of the references.
struct ImageErrors {
    double squared = 0;      ///< mean((x - a)(x - b)): the square of the RMSE
    double relative = 0;     ///< relMSE: mean((x - a)(x - b) / (r^2 + e)), r = (a + b) / 2, e = 0.01 mean(r)^2
    double trimmed = 0;      ///< relMSE without the pixels with the largest errors, one in a thousand (at least one)
    std::size_t broken = 0;  ///< pixels with a NaN or an infinity; the means leave them out
};

/// The share of pixels that `trimmed` leaves out.
inline constexpr double trimmed_share = 1e-3;

/// Measures images of one configuration, each with a seed of its own, against a reference.
///
/// The estimate has a small bias of second order where the references are noisy relative to r, because r depends on
/// their noise. Source of the relative error: F. Rousselle, C. Knaus, M. Zwicker, "Adaptive Sampling and Reconstruction
/// using Greedy Error Minimization", SIGGRAPH Asia 2011.
class ErrorMeter {
  public:
    /// The reference must outlive the meter.
    explicit ErrorMeter(const Reference& reference);

    /// The errors of an image, which also counts for reference_variance(). Throws InputError if its size differs.
    ImageErrors add(const FloatImage& image);

    /// The part of the variance of the mean errors that more seeds do not reduce: that of the references, which all
    /// images share. 0 if the reference is exact. Needs an image.
    ///
    /// With a = truth + u, b = truth + v and the mean x of all images, the noise of u and v adds
    /// sum(u v - (x - truth)(u + v)) to the estimate. Its variance is estimated without bias for Gaussian noise by the
    /// sum over pixels of ((x - (a + b) / 2) . (a - b))^2: u + v and u - v are independent then.
    struct Variance {
        double squared = 0;
        double relative = 0;
    };
    [[nodiscard]] Variance reference_variance() const;

    /// The mean of all images that were added. Pixels that are not finite count as the reference's.
    [[nodiscard]] FloatImage mean_image() const;

  private:
    const Reference& reference_;
    std::vector<Vec3d> weights_;  ///< of the relative error
    std::vector<Vec3d> sums_;
    std::size_t count_ = 0;
};

}  // namespace tandem
