/// The matrix that transforms normals.
#pragma once

#include "tandem/math/transform.h"

namespace tandem {

/// det(m) * inverse(transpose(m)), up to a positive factor, for any m: it transforms normals as m transforms points.
[[nodiscard]] Matrix3 normal_matrix(const Matrix3& m);

}  // namespace tandem
