/// The Real of a tier (math/real.h) by the tier's name, for sources that are compiled once per tier. Included by .cu
/// files.
#pragma once

#include "tandem/math/fast_math.h"

namespace tandem::cuda::tier_real {

using strict = float;
using precise = double;
using fast = FastFloat;

}  // namespace tandem::cuda::tier_real
