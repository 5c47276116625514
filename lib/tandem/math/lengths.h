/// Norms of vectors, for the preparation of a scene.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// The Euclidean norm; the squares of the components must neither overflow nor underflow.
inline double length(const Vec3d& v) { return square_root(dot(v, v)); }

/// The largest magnitude of a component.
inline double max_norm(const Vec3d& v) { return greater(greater(absolute(v.x), absolute(v.y)), absolute(v.z)); }

}  // namespace tandem
