/// Groups of neighbouring primitives. In the hierarchy that single rays traverse, a leaf is a group, so that a ray is
/// tested against several primitives at once (docs/performance/cpu.md).
#pragma once

#include "tandem/kernel/shapes/hit.h"

namespace tandem {

/// The most primitives of a group.
inline constexpr int group_size = 8;

/// Numbers of the primitives of a group, one after the other. Where there is no primitive they are those of another
/// one, and the id is no_primitive.
template <class T>
using OfGroup = T[group_size];

/// The spheres around primitives of any kind.
struct alignas(64) BodyGroup {
    OfGroup<float> x, y, z, radius;
    OfGroup<std::uint32_t> id;
};

/// The corners of triangles or quads.
template <int corners>
struct alignas(64) FaceGroup {
    OfGroup<float> x[corners], y[corners], z[corners];
    OfGroup<std::uint32_t> id;
};
using TriangleGroup = FaceGroup<3>;
using QuadGroup = FaceGroup<4>;

struct GroupNode;  // group_nodes.h

/// All groups of a scene, which are numbered in this order, and their hierarchy.
struct GroupView {
    const GroupNode* nodes;
    std::uint32_t root;  ///< as GroupNode::child
    const BodyGroup* bodies;
    const TriangleGroup* triangles;
    const QuadGroup* quads;
    std::uint32_t body_groups, triangle_groups, quad_groups;
};

TANDEM_HD_INLINE std::uint32_t group_count(const GroupView& groups) {
    return groups.body_groups + groups.triangle_groups + groups.quad_groups;
}

/// Calls visitor(group) with group `number`, of its own type.
template <class Visitor>
TANDEM_HD_INLINE void visit_group(const GroupView& groups, std::uint32_t number, Visitor visitor) {
    if (number < groups.body_groups) return visitor(groups.bodies[number]);
    number -= groups.body_groups;
    if (number < groups.triangle_groups) return visitor(groups.triangles[number]);
    visitor(groups.quads[number - groups.triangle_groups]);
}

}  // namespace tandem
