/// How far the truths of two references are from each other.
#pragma once

#include "tandem/accuracy/error_estimate.h"
#include "tandem/accuracy/reference.h"

namespace tandem {

/// The RMSE between the images that two references of one size approximate, over all pixels and channels, with its 95 %
/// interval. Throws InputError if the sizes differ.
///
/// The product of the differences of both pairs of images is an estimate of the squared difference without bias: their
/// noise is independent, whether or not a pair shares its seeds. With the mean m and the difference d of the two
/// differences of a pixel, its variance is estimated without bias for Gaussian noise by (m . d)^2, because m and d are
/// independent then.
[[nodiscard]] ErrorEstimate difference_of(const Reference& a, const Reference& b);

}  // namespace tandem
