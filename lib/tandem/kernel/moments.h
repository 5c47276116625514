/// The sums for the variance of a pixel, for backends that render its samples one by one.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// Adds a sample in double. One thread adds all samples of a pixel, in their order, as the path loop does. Pass 0 for a
/// sample that is not finite, as in the sum.
TANDEM_HD void add_sample(const Vec3d& sample, Vec3d& sum, Vec3d& squares) {
    sum = sum + sample;
    squares = squares + sample * sample;
}

}  // namespace tandem
