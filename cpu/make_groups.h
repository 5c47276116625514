/// Makes groups of neighbouring primitives.
#pragma once

#include <vector>

#include "cpu/cut_primitives.h"
#include "cpu/embree_api.h"
#include "cpu/group_nodes.h"
#include "cpu/huge_page_allocator.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem {

struct PrimitiveGroups {
    HugePageVector<BodyGroup> bodies;
    HugePageVector<TriangleGroup> triangles;
    HugePageVector<QuadGroup> quads;
    HugePageVector<GroupNode> nodes;
    std::uint32_t root = 0;  ///< of the nodes, as GroupNode::child

    [[nodiscard]] GroupView view() const;
};

/// Every primitive is in one group, and triangles in the group of each of their pieces. Neighbours by the surface area
/// heuristic, in the order of the tree, whose boxes are padded by `margin`, metres. `cut`: cut_triangles() of the
/// scene. To be called in a TBB arena. Throws EnvironmentError if there is not enough memory.
[[nodiscard]] PrimitiveGroups make_groups(RTCDevice device, const SceneView& scene, const CutPrimitives& cut,
                                          float margin);

}  // namespace tandem
