/// A triangle for each lane of a packet, so that a formula runs once for all lanes, not once for each triangle.
#pragma once

#include "tandem/kernel/shapes/parametrisation.h"
#include "tandem/kernel/shapes/ray_source.h"
#include "tandem/kernel/shapes/shading_normal.h"
#include "tandem/math/lookup_table.h"

namespace tandem {

/// The attributes of these triangles. What formulas branch on is the same for all.
template <class Real>
struct LaneAttributes {
    UInt<Real> normals, texcoords;  ///< as in FaceAttributes
    bool has_normals = false, has_texcoords = false;
    FaceSides sides = FaceSides::single_sided;
};

/// World space, metres.
template <class Real>
struct LaneCorners {
    Vec3<Float<Real>> v0, v1, v2;
};

/// Every lane has a triangle that is not degenerate.
template <class Real>
struct TriangleLanes : LaneCorners<Real> {
    LaneAttributes<Real> attributes;
};

/// The corners of those of `count` triangles that are at `index`.
template <class Real>
TANDEM_HD_INLINE LaneCorners<Real> load_corners(const Triangle* triangles, std::uint32_t count,
                                                const UInt<Real>& index) {
    const float* first = &triangles->v0.x;
    const auto number = [&](int i) {
        const LookupTable<float, sizeof(Triangle) / sizeof(float)> numbers = {first + i, count};
        return Float<Real>(numbers[index]);
    };
    const auto corner = [&](int i) { return Vec3<Float<Real>>{number(3 * i), number(3 * i + 1), number(3 * i + 2)}; };
    return {corner(0), corner(1), corner(2)};
}

template <class Real>
inline constexpr bool is_face<TriangleLanes<Real>> = true;
template <class Real>
inline constexpr std::uint32_t corner_count<TriangleLanes<Real>> = 3;

/// Values at corners that lanes can look up: those at indices below this.
inline constexpr std::uint32_t most_lane_corners = 1U << 27;

template <class Real>
TANDEM_HD_INLINE HitRecord<Real> record_hit(const TriangleLanes<Real>&, const Ray<Real>&, const Double<Real>&,
                                            const Mask<Real>&, const Mask<Real>&) {
    return {};
}

/// As shading_normal() of one triangle. `normals`: of all corners of the scene.
template <class Real>
TANDEM_HD_CALL Vec3<Double<Real>> shading_normal(const TriangleLanes<Real>& triangles, const Vec3f* normals,
                                                 const Ray<Real>& ray, const Mask<Real>& here) {
    const LaneAttributes<Real>& attributes = triangles.attributes;
    const auto corner = [&](int i) {
        const UInt<Real> index = attributes.normals + UInt<Real>(static_cast<std::uint32_t>(i));
        const auto component = [&](int axis) {
            const LookupTable<float, 3> numbers = {&normals->x + axis, most_lane_corners};
            return widen(Float<Real>(numbers[index]));
        };
        return Vec3<Double<Real>>{component(0), component(1), component(2)};
    };
    return shading_normal_detail::interpolated(triangles.v0, triangles.v1, triangles.v2, attributes.has_normals, corner,
                                               attributes.sides == FaceSides::double_sided, ray, here);
}

/// As parametrisation() of one triangle. `texcoords`: one slot of those of the scene.
template <class Real>
TANDEM_HD_INLINE Parametrisation<Real> parametrisation(const TriangleLanes<Real>& triangles, const HitRecord<Real>&,
                                                       const Vec2f* texcoords, const Ray<Real>& ray,
                                                       const Double<Real>&, const Mask<Real>& here) {
    using Uv = Vec2<Float<Real>>;
    const LaneAttributes<Real>& attributes = triangles.attributes;
    const auto corner = [&](std::uint32_t i) {
        if (!attributes.has_texcoords) {
            const Vec2f uv = parametrisation_detail::default_corners<3>().uv[i];
            return Uv{uv.x, uv.y};
        }
        const UInt<Real> index = attributes.texcoords + UInt<Real>(i);
        const LookupTable<float, 2> u = {&texcoords->x, most_lane_corners}, v = {&texcoords->y, most_lane_corners};
        return Uv{u[index], v[index]};
    };
    return parametrisation_detail::on_triangle<Real>(triangles.v0, triangles.v1, triangles.v2, corner(0), corner(1),
                                                     corner(2), ray, here);
}

}  // namespace tandem
