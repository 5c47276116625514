/// Norms of vectors.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// The Euclidean norm; the squares of the components must neither overflow nor underflow.
TANDEM_HD_INLINE double length(const Vec3d& v) { return square_root(dot(v, v)); }

/// The largest magnitude of a component.
template <class Real>
TANDEM_HD_INLINE Real max_norm(const Vec3<Real>& v) {
    return greater(greater(absolute(v.x), absolute(v.y)), absolute(v.z));
}

}  // namespace tandem
