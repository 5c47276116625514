/// The quadrilateral: two triangles with a fixed diagonal.
#pragma once

#include "tandem/kernel/shapes/triangle.h"

namespace tandem {

/// The triangles (v0, v1, v2) and (v0, v2, v3), flat or folded along v0 v2; neither is degenerate. World space, metres.
struct alignas(16) Quad {
    Vec3f v0, v1, v2, v3;
    FaceAttributes attributes{};
    std::uint32_t unused = 0;  ///< otherwise padding bytes, undefined
};
static_assert(sizeof(Quad) == 64, "no byte of a quad is undefined; scene_hash() reads all");

TANDEM_HD_INLINE Aabb bounds(const Quad& quad) { return box_around(quad.v0, quad.v1, quad.v2, quad.v3); }

/// Whether the ray may touch one of the two triangles; false only for certain misses.
template <class Real>
TANDEM_HD_INLINE Mask<Real> may_touch_quad(const FilterRay<Real>& f, const Quad& quad) {
    return may_touch_triangle(f, quad.v0, quad.v1, quad.v2) || may_touch_triangle(f, quad.v0, quad.v2, quad.v3);
}

/// The nearer of the hits on the two triangles that count. Watertight at the diagonal, like two triangles of a mesh; a
/// hit on the diagonal belongs to the first triangle. `counts` takes the lanes that hit a triangle, t, and the
/// triangle's last two corners; it returns the lanes whose hit counts. Otherwise as first_hit() of a triangle.
/// Tested by tests/kernel/shapes/quad_test.cpp.
template <class Real, class Counts>
TANDEM_HD_INLINE Mask<Real> first_that_counts(const Quad& quad, const Ray<Real>& ray, Double<Real>& t,
                                              const Mask<Real>& active, const Double<Real>& farthest,
                                              const Counts& counts) {
    Double<Real> t_second(0.0);
    const Mask<Real> on_first = first_hit(quad.v0, quad.v1, quad.v2, ray, t, active, farthest);
    const Mask<Real> on_second = first_hit(quad.v0, quad.v2, quad.v3, ray, t_second, active, farthest);
    const Mask<Real> first = counts(on_first, t, quad.v1, quad.v2);
    const Mask<Real> second = counts(on_second && !(on_first && t == t_second), t_second, quad.v2, quad.v3);
    t = select(second && !(first && t < t_second), t_second, t);
    return first || second;
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> first_hit(const Quad& quad, const Ray<Real>& ray, Double<Real>& t,
                                      const Mask<Real>& active = Mask<Real>(true),
                                      const Double<Real>& farthest = Double<Real>(__builtin_huge_val())) {
    const auto all = [](const Mask<Real>& hit, const Double<Real>&, const Vec3f&, const Vec3f&) { return hit; };
    return first_that_counts(quad, ray, t, active, farthest, all);
}

/// The triangle that a ray hits at t, in the lanes of `here`; t is that of first_hit(). The first triangle on the
/// diagonal.
template <class Real>
TANDEM_HD_INLINE HitRecord<Real> record_hit(const Quad& quad, const Ray<Real>& ray, const Double<Real>& t,
                                            const Mask<Real>&, const Mask<Real>& here) {
    Double<Real> t_first(0.0);
    const Mask<Real> first = first_hit(quad.v0, quad.v1, quad.v2, ray, t_first, here) && t_first == t;
    return {select(first, UInt<Real>(0U), UInt<Real>(1U))};
}
template <class Real>
TANDEM_HD_INLINE Mask<Real> is_in_first_half(const HitRecord<Real>& record) {
    return record.part == UInt<Real>(0U);
}

/// Coordinates on a quad, 0 to 1 along v0 v1 and v0 v3, affine in each triangle and the same on both sides of the
/// diagonal: v0 is (0, 0), v1 (1, 0), v2 (1, 1), v3 (0, 1). On a parallelogram they are affine throughout. `at`:
/// barycentric coordinates in the triangle that `first_half` selects.
template <class Real>
TANDEM_HD_INLINE Barycentrics<Double<Real>> quad_coordinates(const Barycentrics<Double<Real>>& at,
                                                             const Mask<Real>& first_half) {
    const Double<Real> sum = at.u + at.v;
    return {select(first_half, sum, at.u), select(first_half, at.v, sum)};
}

}  // namespace tandem
