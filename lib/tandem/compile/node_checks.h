/// Checks for nodes that prepare() refuses or leaves out.
#pragma once

#include <cmath>
#include <cstddef>
#include <string>

#include "tandem/math/ray.h"
#include "tandem/scene/scene.h"

namespace tandem {

/// Throws InputError: "node 3 'lamp' has ".
[[noreturn]] void fail_at_node(const Scene& scene, std::size_t node, const std::string& what);

/// Throws InputError if a point of the box centre +- half_extent, in world space, is beyond coordinate_limit.
inline void check_reach(const Scene& scene, std::size_t node, const Vec3d& centre, const Vec3d& half_extent) {
    for (int i = 0; i < 3; ++i) {
        if (!(std::abs(centre[i]) + half_extent[i] <= double{coordinate_limit})) {
            fail_at_node(scene, node, "coordinates farther than 1e18 from the origin");
        }
    }
}

/// Whether a transform shrinks a solid to a line or a point, up to rounding. Animations hide objects in this way.
[[nodiscard]] bool is_hidden(const Matrix3& m);

}  // namespace tandem
