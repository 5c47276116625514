#include "tandem/scene/normal_matrix.h"

#include <algorithm>

#include "tandem/math/lengths.h"

namespace tandem {

Matrix3 normal_matrix(const Matrix3& m) {
    Matrix3 cofactors = {{cross(m.row[1], m.row[2]), cross(m.row[2], m.row[0]), cross(m.row[0], m.row[1])}};
    double largest = 0;
    for (const Vec3d& row : cofactors.row) largest = std::max(largest, max_norm(row));
    if (!(largest > 0)) return cofactors;
    const double sign = determinant(m) < 0 ? -1 : 1;
    for (Vec3d& row : cofactors.row) row = row / (largest * sign);
    return cofactors;
}

}  // namespace tandem
