/// How transforms turn normals.
#pragma once

#include "tandem/math/transform.h"

namespace tandem {

/// det(m) * inverse(transpose(m)), up to a positive factor; of any m: it turns normals as m turns points.
[[nodiscard]] Matrix3 normal_matrix(const Matrix3& m);

}  // namespace tandem
