/// Lengths of vectors, for the preparation of a scene on the host.
#pragma once

#include <algorithm>
#include <cmath>

#include "tandem/math/vec.h"

namespace tandem {

/// The Euclidean norm; the squares of the components must neither overflow nor underflow.
inline double length(const Vec3d& v) { return std::sqrt(dot(v, v)); }

/// The largest absolute value of a component: the maximum norm.
inline double max_norm(const Vec3d& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

}  // namespace tandem
