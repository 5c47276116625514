#include "cpu/make_groups.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "cpu/embree_handles.h"
#include "tandem/kernel/traversal/make_node.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

/// A node of the tree that the builder makes, in its memory.
struct TreeNode {
    std::uint32_t children;  ///< 0 for a leaf
};
struct InnerNode : TreeNode {
    static constexpr unsigned most = 8;
    const TreeNode* child[most];
};
struct Leaf : TreeNode {
    std::uint32_t count;
    std::uint32_t id[group_size];
};

void* make_inner_node(RTCThreadLocalAllocator allocator, unsigned int children, void*) {
    auto* node = static_cast<InnerNode*>(rtcThreadLocalAlloc(allocator, sizeof(InnerNode), alignof(InnerNode)));
    node->children = children;
    return static_cast<TreeNode*>(node);
}
void set_children(void* node, void** children, unsigned int count, void*) {
    auto* inner = static_cast<InnerNode*>(static_cast<TreeNode*>(node));
    for (unsigned int i = 0; i < count; ++i) inner->child[i] = static_cast<const TreeNode*>(children[i]);
}
void ignore_bounds(void*, const RTCBounds**, unsigned int, void*) {}
void* make_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count, void*) {
    auto* leaf = static_cast<Leaf*>(rtcThreadLocalAlloc(allocator, sizeof(Leaf), alignof(Leaf)));
    leaf->children = 0;
    leaf->count = static_cast<std::uint32_t>(count);
    for (std::size_t i = 0; i < count; ++i) leaf->id[i] = primitives[i].primID;
    // the order in which threads met them is not always the same
    std::sort(leaf->id, leaf->id + count);
    return static_cast<TreeNode*>(leaf);
}

std::vector<const Leaf*> leaves_in_order(const TreeNode* root, std::size_t primitives) {
    std::vector<const Leaf*> leaves;
    leaves.reserve(primitives / (group_size / 2));
    std::vector<const TreeNode*> rest = {root};
    while (!rest.empty()) {
        const TreeNode* node = rest.back();
        rest.pop_back();
        if (node->children == 0) {
            leaves.push_back(static_cast<const Leaf*>(node));
        } else {
            const auto& child = static_cast<const InnerNode*>(node)->child;
            for (std::uint32_t i = node->children; i-- > 0;) rest.push_back(child[i]);
        }
    }
    return leaves;
}

template <class Body>
void for_all(std::size_t count, const Body& body) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1024), [&](const auto& range) {
        const DefaultFpEnvironment guard;
        for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
    });
}

void set_primitive(BodyGroup& group, int place, const SceneView& scene, std::uint32_t id) {
    visit_primitive(scene, id, [&](const auto& primitive) {
        const Sphere around = sphere_around(primitive);
        group.x[place] = around.centre.x;
        group.y[place] = around.centre.y;
        group.z[place] = around.centre.z;
        group.radius[place] = around.radius;
    });
}
template <int corners>
void set_primitive(FaceGroup<corners>& group, int place, const SceneView& scene, std::uint32_t id) {
    const auto set = [&](const auto&... v) {
        int corner = 0;
        ((group.x[corner][place] = v.x, group.y[corner][place] = v.y, group.z[corner][place] = v.z, ++corner), ...);
    };
    visit_primitive(scene, id, [&]<class Face>(const Face& f) {
        if constexpr (corners == 3 && std::is_same_v<Face, Triangle>) set(f.v0, f.v1, f.v2);
        if constexpr (corners == 4 && std::is_same_v<Face, Quad>) set(f.v0, f.v1, f.v2, f.v3);
    });
}

/// Groups of primitives [first, first + count).
template <class Group>
std::vector<Group> group(RTCDevice device, const SceneView& scene, std::uint32_t first, std::uint32_t count) {
    if (count == 0) return {};
    std::vector<RTCBuildPrimitive> boxes(count);
    for_all(count, [&](std::size_t i) {
        const std::uint32_t id = first + static_cast<std::uint32_t>(i);
        const Aabb box = primitive_bounds(scene, id);
        boxes[i] = {box.lower.x, box.lower.y, box.lower.z, 0, box.upper.x, box.upper.y, box.upper.z, id};
    });
    const EmbreeTree tree(rtcNewBVH(device));
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.bvh = tree.get();
    arguments.primitives = boxes.data();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = count;
    arguments.maxBranchingFactor = InnerNode::most;
    arguments.maxDepth = 64;
    arguments.sahBlockSize = arguments.minLeafSize = arguments.maxLeafSize = group_size;
    arguments.createNode = make_inner_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = ignore_bounds;
    arguments.createLeaf = make_leaf;
    const auto* root = static_cast<const TreeNode*>(rtcBuildBVH(&arguments));
    check_embree(device, "grouping primitives");
    const std::vector<const Leaf*> leaves = leaves_in_order(root, count);
    std::vector<Group> groups(leaves.size());
    for_all(leaves.size(), [&](std::size_t i) {
        const Leaf& leaf = *leaves[i];
        for (int place = 0; place < group_size; ++place) {
            const bool is_there = static_cast<std::uint32_t>(place) < leaf.count;
            groups[i].id[place] = is_there ? leaf.id[place] : no_primitive;
            set_primitive(groups[i], place, scene, leaf.id[is_there ? place : 0]);
        }
    });
    return groups;
}

}  // namespace

GroupView PrimitiveGroups::view(RTCScene embree) const {
    const auto size = [](const auto& groups) { return static_cast<std::uint32_t>(groups.size()); };
    return {embree, bodies.data(), triangles.data(), quads.data(), size(bodies), size(triangles), size(quads)};
}

PrimitiveGroups make_groups(RTCDevice device, const SceneView& scene) {
    const std::uint32_t triangles = scene.triangle_count, quads = scene.quad_count;
    const std::uint32_t bodies = primitive_count(scene) - triangles - quads;
    return {group<BodyGroup>(device, scene, 0, bodies), group<TriangleGroup>(device, scene, bodies, triangles),
            group<QuadGroup>(device, scene, bodies + triangles, quads)};
}

const OfGroup<std::uint32_t>& ids_of_group(const GroupView& groups, std::uint32_t number) {
    const OfGroup<std::uint32_t>* ids = nullptr;
    visit_group(groups, number, [&](const auto& group) { ids = &group.id; });
    return *ids;
}

}  // namespace tandem
