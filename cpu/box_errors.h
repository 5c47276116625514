/// Which of Embree's box tests suit a scene.
#pragma once

#include <algorithm>
#include <cstdint>

#include "tandem/kernel/traversal/proposal.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem {

/// `bounds`: of all primitives, not padded. Embree's usual tests err by a part of the reach of the scene, its robust
/// ones, which are slower, by a part of the distance. So a scene gets the robust ones if, of up to 16,384 primitives at
/// equal steps through the list, one in 64 is smaller than four times the padding that the usual tests need: among many
/// of these a ray would enter the boxes of all. A guess, which affects only the speed.
[[nodiscard]] inline BoxErrors box_errors_for(const SceneView& scene, const Aabb& bounds) {
    constexpr std::uint32_t most = 16'384;
    const float padding = make_structure_frame(bounds, BoxErrors::of_scene).padding.least;
    const std::uint32_t count = primitive_count(scene), step = (count - 1) / most + 1;
    std::uint32_t tested = 0, tiny = 0;
    for (std::uint32_t id = 0; id < count; id += step, ++tested) {
        const Aabb box = primitive_bounds(scene, id);
        const Vec3f extent = box.upper - box.lower;
        if (std::max({extent.x, extent.y, extent.z}) < 4 * padding) ++tiny;
    }
    return 64 * tiny >= tested ? BoxErrors::of_distance : BoxErrors::of_scene;
}

}  // namespace tandem
