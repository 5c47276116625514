/// Makes groups of neighbouring primitives.
#pragma once

#include <vector>

#include "cpu/embree_api.h"
#include "cpu/primitive_groups.h"
#include "tandem/kernel/view/scene_view.h"

namespace tandem {

struct PrimitiveGroups {
    std::vector<BodyGroup> bodies;
    std::vector<TriangleGroup> triangles;
    std::vector<QuadGroup> quads;

    /// `embree`: their hierarchy.
    [[nodiscard]] GroupView view(RTCScene embree) const;
};

/// Every primitive is in one group. Neighbours by the surface area heuristic, in the order of the tree. To be called in
/// a TBB arena. Throws EnvironmentError if there is not enough memory.
[[nodiscard]] PrimitiveGroups make_groups(RTCDevice device, const SceneView& scene);

/// The ids of group `number`; no_primitive comes last.
[[nodiscard]] const OfGroup<std::uint32_t>& ids_of_group(const GroupView& groups, std::uint32_t number);

}  // namespace tandem
