/// How many triangles rays pass close to before they hit one. Tested by tests/compile/crossed_boxes_test.cpp.
#pragma once

#include <cstdint>

#include "tandem/kernel/traversal/collapse.h"
#include "tandem/kernel/view/scene_view.h"
#include "tandem/math/lengths.h"

namespace tandem {

namespace crossed_boxes_detail {

/// The sum over the triangles of half_area(triangle), estimated from up to 1024 of them, over half the area of
/// `bounds`: how many things with these areas a line through `bounds` hits on average, if they are convex or flat (M.
/// W. Crofton, 1868).
template <class HalfArea>
double crossed(const SceneView& scene, const Aabb& bounds, const HalfArea& half_area) {
    constexpr std::uint32_t most_inspected = 1024;
    const std::uint32_t count = scene.triangle_count;
    if (count == 0) return 0;
    const std::uint32_t inspected = count < most_inspected ? count : most_inspected;
    double area = 0;
    for (std::uint32_t i = 0; i < inspected; ++i) {
        area += half_area(scene.triangles[static_cast<std::uint32_t>(std::uint64_t{count} * i / inspected)]);
    }
    return area / inspected * count / wide_half_area(bounds);
}

}  // namespace crossed_boxes_detail

/// How many boxes of triangles a line through `bounds` hits on average: 4 for a sphere of 1.3 million triangles, 8.8
/// for a million triangles without order (named:triangles/1000000), and more for long, thin ones.
[[nodiscard]] inline double crossed_boxes(const SceneView& scene, const Aabb& bounds) {
    return crossed_boxes_detail::crossed(scene, bounds,
                                         [](const Triangle& t) { return wide_half_area(tandem::bounds(t)); });
}

/// How many of these boxes a ray through `bounds` enters before it hits a triangle, roughly: the boxes over one more
/// than the triangles that a line hits.
[[nodiscard]] inline double boxes_before_a_hit(const SceneView& scene, const Aabb& bounds) {
    const double hits = crossed_boxes_detail::crossed(scene, bounds, [](const Triangle& t) {
        return 0.5 * length(cross(widen(t.v1) - widen(t.v0), widen(t.v2) - widen(t.v0)));
    });
    return crossed_boxes(scene, bounds) / (1 + hits);
}

}  // namespace tandem
