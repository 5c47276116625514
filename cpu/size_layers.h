/// A scene in layers by the size of its primitives, each with a hierarchy of its own. Embree's box tests err by a part
/// of the reach of a hierarchy (proposal.h). If that is more than the size of many primitives, their padded boxes
/// overlap, and a ray enters all of them. In a layer of their own they need less padding. Tested by
/// tests/cpu/size_layers_test.cpp and tests/agree/huge_primitives_test.cpp.
#pragma once

#include <limits>
#include <vector>

#include "tandem/kernel/view/scene_view.h"

namespace tandem {

/// Sizes in [least, below), in metres.
struct SizeRange {
    float least = 0.0F;
    float below = std::numeric_limits<float>::infinity();

    /// Whether the largest extent of `box` is such a size.
    [[nodiscard]] bool contains(const Aabb& box) const {
        const Vec3f extent = box.upper - box.lower;
        const float size = reach(Aabb{{0, 0, 0}, extent});
        return size >= least && size < below;
    }
};

struct SizeLayer {
    SizeRange sizes;
    Aabb bounds;  ///< of its primitives, not padded
};

/// From large to small; one layer for most scenes. To be called in a TBB arena. The scene must not be empty.
[[nodiscard]] std::vector<SizeLayer> divide_by_size(const SceneView& scene);

}  // namespace tandem
