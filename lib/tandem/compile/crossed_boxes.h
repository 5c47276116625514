/// How many triangles rays pass close to before they hit one. Tested by tests/compile/crossed_boxes_test.cpp.
#pragma once

#include <cstdint>

#include "tandem/kernel/traversal/collapse.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem {

/// How many boxes of triangles a line through `bounds` hits on average, by their area relative to that of `bounds`,
/// estimated from up to 1024 triangles: 4 for a sphere of 1.3 million triangles, 8.8 for a million triangles without
/// order (named:triangles/1000000), and more for long, thin ones.
[[nodiscard]] inline double crossed_boxes(const SceneView& scene, const Aabb& bounds) {
    constexpr std::uint32_t most_inspected = 1024;
    const std::uint32_t count = scene.triangle_count;
    if (count == 0) return 0;
    const std::uint32_t inspected = count < most_inspected ? count : most_inspected;
    double area = 0;
    for (std::uint32_t i = 0; i < inspected; ++i) {
        const auto id = static_cast<std::uint32_t>(std::uint64_t{count} * i / inspected);
        area += wide_half_area(tandem::bounds(scene.triangles[id]));
    }
    return area / inspected * count / wide_half_area(bounds);
}

}  // namespace tandem
