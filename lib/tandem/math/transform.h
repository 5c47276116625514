/// Affine transforms in double, named target-from-source: world_from_object maps object space to world space, and
/// world_from_object = world_from_parent * parent_from_object.
#pragma once

#include "tandem/math/vec.h"

namespace tandem {

/// Unit quaternion (x, y, z, w), w the real part, as in glTF.
struct Quaternion {
    double x = 0, y = 0, z = 0, w = 1;
};

/// Rows of a 3 x 3 matrix.
struct Matrix3 {
    Vec3d row[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};

TANDEM_HD_INLINE Vec3d operator*(const Matrix3& m, const Vec3d& v) {
    return {dot(m.row[0], v), dot(m.row[1], v), dot(m.row[2], v)};
}

template <class Real>
TANDEM_HD_INLINE Vec3<Real> multiply(const Matrix3& m, const Vec3<Real>& v) {
    return {dot(constant<Real>(m.row[0]), v), dot(constant<Real>(m.row[1]), v), dot(constant<Real>(m.row[2]), v)};
}

TANDEM_HD_INLINE Matrix3 transpose(const Matrix3& m) {
    return {{{m.row[0].x, m.row[1].x, m.row[2].x},
             {m.row[0].y, m.row[1].y, m.row[2].y},
             {m.row[0].z, m.row[1].z, m.row[2].z}}};
}

TANDEM_HD_INLINE Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
    const Matrix3 columns = transpose(b);
    Matrix3 product;
    for (int i = 0; i < 3; ++i) {
        product.row[i] = {dot(a.row[i], columns.row[0]), dot(a.row[i], columns.row[1]), dot(a.row[i], columns.row[2])};
    }
    return product;
}

TANDEM_HD_INLINE double determinant(const Matrix3& m) { return dot(m.row[0], cross(m.row[1], m.row[2])); }

/// Needs a determinant that is not zero.
TANDEM_HD_INLINE Matrix3 inverse(const Matrix3& m) {
    const double scale = 1.0 / determinant(m);
    return transpose(
        {{cross(m.row[1], m.row[2]) * scale, cross(m.row[2], m.row[0]) * scale, cross(m.row[0], m.row[1]) * scale}});
}

/// Rotation matrix of a quaternion, which need not be normalised but must not be zero.
TANDEM_HD_INLINE Matrix3 rotation_matrix(const Quaternion& q) {
    const double s = 2.0 / (q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return {{{1.0 - s * (q.y * q.y + q.z * q.z), s * (q.x * q.y - q.z * q.w), s * (q.x * q.z + q.y * q.w)},
             {s * (q.x * q.y + q.z * q.w), 1.0 - s * (q.x * q.x + q.z * q.z), s * (q.y * q.z - q.x * q.w)},
             {s * (q.x * q.z - q.y * q.w), s * (q.y * q.z + q.x * q.w), 1.0 - s * (q.x * q.x + q.y * q.y)}}};
}

/// p -> linear * p + translation.
struct Transform {
    Matrix3 linear;
    Vec3d translation{0, 0, 0};
};

TANDEM_HD_INLINE Vec3d transform_point(const Transform& t, const Vec3d& p) { return t.linear * p + t.translation; }
TANDEM_HD_INLINE Vec3d transform_vector(const Transform& t, const Vec3d& v) { return t.linear * v; }

/// a_from_c = a_from_b * b_from_c.
TANDEM_HD_INLINE Transform operator*(const Transform& a_from_b, const Transform& b_from_c) {
    return {a_from_b.linear * b_from_c.linear, transform_point(a_from_b, b_from_c.translation)};
}

/// translation * rotation * scale, the order of glTF.
TANDEM_HD_INLINE Transform compose(const Vec3d& translation, const Quaternion& rotation, const Vec3d& scale) {
    Matrix3 linear = rotation_matrix(rotation);
    for (auto& row : linear.row) row = row * scale;
    return {linear, translation};
}

}  // namespace tandem
