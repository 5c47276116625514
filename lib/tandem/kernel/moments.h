/// What the variance of a pixel is made of, for backends that draw its samples one by one.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// Adds a sample: in double, in the order of the samples, by one owner, as the path loop adds them. A sample that is
/// not finite is a 0 here, as it is in the sum.
TANDEM_HD void add_sample(const Vec3d& sample, Vec3d& sum, Vec3d& squares) {
    sum = sum + sample;
    squares = squares + sample * sample;
}

}  // namespace tandem
