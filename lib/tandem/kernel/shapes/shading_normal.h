/// Shading normals of faces: interpolated between the corners, or the geometric normal.
#pragma once

#include "tandem/kernel/shapes/quad.h"

namespace tandem {

/// The shading normals of the corners of a face; null if it has none.
TANDEM_HD_INLINE const Vec3f* corner_normals(const Vec3f* normals, const FaceAttributes& attributes) {
    return attributes.normals == no_attributes ? nullptr : normals + attributes.normals;
}

namespace shading_normal_detail {

/// See shading_normal(). `corner(i)`: the normal of corner i, in the precision of decisions, if `has_normals`.
template <class Real, class Number, class Corner>
TANDEM_HD_INLINE Vec3<Double<Real>> interpolated(const Vec3<Number>& v0, const Vec3<Number>& v1, const Vec3<Number>& v2,
                                                 bool has_normals, const Corner& corner, bool double_sided,
                                                 const Ray<Real>& ray, const Mask<Real>& here) {
    using D = Double<Real>;
    const Vec3<D> own = geometric_normal<Real>(v0, v1, v2);
    Vec3<D> normal = own;
    if (has_normals) {
        const Barycentrics<D> at = barycentrics(v0, v1, v2, ray, here);
        const D rest = (D(1.0) - at.u) - at.v;
        const Vec3<D> sum = corner(0) * rest + corner(1) * at.u + corner(2) * at.v;
        const Mask<Real> enough = dot(sum, sum) > D(0x1p-40);
        normal = select(enough, normalize(sum), own);
    }
    if (double_sided) {
        const Mask<Real> behind = dot(widen(ray.direction), own) > D(0.0);
        normal = select(behind, -normal, normal);
    }
    return normal;
}

}  // namespace shading_normal_detail

/// Unit shading normal, world space, where a ray hits the triangle (v0, v1, v2), in the lanes of `here`.
///
/// `normals`: of the corners, unit or 0, at indices 0, `second` and `second` + 1; null for a face without. They are
/// interpolated linearly and normalised (Phong's interpolation), in double. Where the sum is shorter than 2^-20, and
/// without normals, the result is the geometric normal. On a double-sided face it is flipped to the side of the ray's
/// origin, which the geometric normal decides. Source: B. T. Phong, "Illumination for Computer Generated Pictures",
/// CACM 18(6), 1975; glTF 2.0, 3.9.6 on sides.
template <class Real>
TANDEM_HD_CALL Vec3<Double<Real>> shading_normal(Vec3f v0, Vec3f v1, Vec3f v2, const Vec3f* normals, int second,
                                                 bool double_sided, Ray<Real> ray, Mask<Real> here) {
    const auto corner = [&](int i) { return broadcast<Double<Real>>(normals[i == 0 ? 0 : second + i - 1]); };
    return shading_normal_detail::interpolated(v0, v1, v2, normals != nullptr, corner, double_sided, ray, here);
}

/// `normals`: of the corners, in their order, or null.
template <class Real>
TANDEM_HD_INLINE Vec3<Double<Real>> shading_normal(const Triangle& triangle, const Vec3f* normals, const Ray<Real>& ray,
                                                   const Mask<Real>& here) {
    return shading_normal<Real>(triangle.v0, triangle.v1, triangle.v2, normals, 1, is_double_sided(triangle.attributes),
                                ray, here);
}

/// The same for the half of the quad that the ray hits.
template <class Real>
TANDEM_HD_INLINE Vec3<Double<Real>> shading_normal(const Quad& quad, const HitRecord<Real>& record,
                                                   const Vec3f* normals, const Ray<Real>& ray, const Mask<Real>& here) {
    const bool double_sided = is_double_sided(quad.attributes);
    const Mask<Real> first = is_in_first_half(record);
    Vec3<Double<Real>> normal{};
    if (any(here && first)) {
        normal = shading_normal<Real>(quad.v0, quad.v1, quad.v2, normals, 1, double_sided, ray, here && first);
    }
    if (any(here && !first)) {
        const auto second =
            shading_normal<Real>(quad.v0, quad.v2, quad.v3, normals, 2, double_sided, ray, here && !first);
        normal = select(first, normal, second);
    }
    return normal;
}

}  // namespace tandem
