#include "cpu/make_groups.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "cpu/embree_handles.h"
#include "cpu/group_walk.h"
#include "tandem/kernel/traversal/make_node.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

/// A node of the tree that the builder makes, in its memory.
struct TreeNode {
    std::uint32_t children;  ///< 0 for a leaf
};
struct InnerNode : TreeNode {
    const TreeNode* child[group_node_width];
    RTCBounds bounds[group_node_width];
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
void set_bounds(void* node, const RTCBounds** bounds, unsigned int count, void*) {
    auto* inner = static_cast<InnerNode*>(static_cast<TreeNode*>(node));
    for (unsigned int i = 0; i < count; ++i) inner->bounds[i] = *bounds[i];
}
void* make_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count, void*) {
    auto* leaf = static_cast<Leaf*>(rtcThreadLocalAlloc(allocator, sizeof(Leaf), alignof(Leaf)));
    leaf->children = 0;
    for (std::size_t i = 0; i < count; ++i) leaf->id[i] = primitives[i].primID;
    // their order depends on the threads; and pieces of one primitive may meet
    std::sort(leaf->id, leaf->id + count);
    leaf->count = static_cast<std::uint32_t>(std::unique(leaf->id, leaf->id + count) - leaf->id);
    return static_cast<TreeNode*>(leaf);
}

template <class Bounds>
Aabb box_of(const Bounds& b) {
    return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}

/// Copies a tree in depth-first order.
class TreeCopy {
  public:
    /// `first_group`: the number of the first leaf's group. Boxes are padded by `margin`.
    TreeCopy(HugePageVector<GroupNode>& nodes, std::uint32_t first_group, float margin)
        : nodes_(nodes), first_group_(first_group), margin_(margin) {}

    /// Returns the number of the copy, as GroupNode::child.
    std::uint32_t add(const TreeNode& tree) {
        if (tree.children == 0) {
            leaves_.push_back(&static_cast<const Leaf&>(tree));
            return group_bit | (first_group_ + static_cast<std::uint32_t>(leaves_.size() - 1));
        }
        const auto& inner = static_cast<const InnerNode&>(tree);
        const std::size_t number = nodes_.size();
        nodes_.emplace_back();
        GroupChild children[group_node_width];
        for (std::uint32_t i = 0; i < inner.children; ++i) {
            children[i] = {box_of(inner.bounds[i]), add(*inner.child[i])};
        }
        nodes_[number] = make_group_node(children, inner.children, margin_);
        return static_cast<std::uint32_t>(number);
    }
    [[nodiscard]] const std::vector<const Leaf*>& leaves() const { return leaves_; }

  private:
    HugePageVector<GroupNode>& nodes_;
    std::vector<const Leaf*> leaves_;
    std::uint32_t first_group_;
    float margin_;
};

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

/// Groups of primitives [first, first + count), and the trees of all groups, with padded boxes.
class GroupMaker {
  public:
    GroupMaker(RTCDevice device, const SceneView& scene, float margin)
        : device_(device), scene_(scene), margin_(margin) {}

    template <class Group>
    HugePageVector<Group> make(std::uint32_t first, std::uint32_t count, const CutPrimitives& cut = {}) {
        if (count == 0) return {};
        std::vector<RTCBuildPrimitive> boxes(count + cut.further.size());
        Aabb all;
        for_all(boxes.size(), [&](std::size_t i) {
            const PrimitivePiece piece = i < count ? cut.first_piece(first, i) : cut.further[i - count];
            const Aabb box = piece.count > 1 ? piece_bounds(scene_, piece) : primitive_bounds(scene_, piece.primitive);
            boxes[i] = {box.lower.x, box.lower.y, box.lower.z, 0,
                        box.upper.x, box.upper.y, box.upper.z, piece.primitive};
        });
        for (const RTCBuildPrimitive& box : boxes) all = merge(all, box_of(box));
        const EmbreeTree tree(rtcNewBVH(device_));
        RTCBuildArguments arguments = rtcDefaultBuildArguments();
        arguments.bvh = tree.get();
        arguments.primitives = boxes.data();
        arguments.primitiveCount = arguments.primitiveArrayCapacity = boxes.size();
        arguments.maxBranchingFactor = group_node_width;
        arguments.maxDepth = group_depth - 1;
        arguments.sahBlockSize = arguments.minLeafSize = arguments.maxLeafSize = group_size;
        arguments.createNode = make_inner_node;
        arguments.setNodeChildren = set_children;
        arguments.setNodeBounds = set_bounds;
        arguments.createLeaf = make_leaf;
        const auto* root = static_cast<const TreeNode*>(rtcBuildBVH(&arguments));
        check_embree(device_, "grouping primitives");
        TreeCopy copy(nodes_, groups_, margin_);
        roots_[root_count_++] = {all, copy.add(*root)};
        const std::vector<const Leaf*>& leaves = copy.leaves();
        groups_ += static_cast<std::uint32_t>(leaves.size());
        HugePageVector<Group> groups(leaves.size());
        for_all(leaves.size(), [&](std::size_t i) {
            const Leaf& leaf = *leaves[i];
            for (int place = 0; place < group_size; ++place) {
                const bool is_there = static_cast<std::uint32_t>(place) < leaf.count;
                groups[i].id[place] = is_there ? leaf.id[place] : no_primitive;
                set_primitive(groups[i], place, scene_, leaf.id[is_there ? place : 0]);
            }
        });
        return groups;
    }

    /// The trees as one. Returns its root.
    std::uint32_t join() {
        if (root_count_ == 1) return roots_[0].number;
        nodes_.push_back(make_group_node(roots_, root_count_, margin_));
        return static_cast<std::uint32_t>(nodes_.size() - 1);
    }
    HugePageVector<GroupNode> take_nodes() { return std::move(nodes_); }

  private:
    RTCDevice device_;
    const SceneView& scene_;
    float margin_;
    HugePageVector<GroupNode> nodes_;
    GroupChild roots_[3];
    std::uint32_t root_count_ = 0;
    std::uint32_t groups_ = 0;
};

}  // namespace

GroupView PrimitiveGroups::view() const {
    const auto size = [](const auto& groups) { return static_cast<std::uint32_t>(groups.size()); };
    return {nodes.data(), root,         bodies.data(),   triangles.data(),
            quads.data(), size(bodies), size(triangles), size(quads)};
}

PrimitiveGroups make_groups(RTCDevice device, const SceneView& scene, const CutPrimitives& cut, float margin) {
    const std::uint32_t triangles = scene.triangle_count, quads = scene.quad_count;
    const std::uint32_t bodies = primitive_count(scene) - triangles - quads;
    GroupMaker maker(device, scene, margin);
    PrimitiveGroups groups;
    groups.bodies = maker.make<BodyGroup>(0, bodies);
    groups.triangles = maker.make<TriangleGroup>(bodies, triangles, cut);
    groups.quads = maker.make<QuadGroup>(bodies + triangles, quads);
    groups.root = maker.join();
    groups.nodes = maker.take_nodes();
    return groups;
}

}  // namespace tandem
