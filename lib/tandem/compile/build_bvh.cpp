#include "tandem/compile/build_bvh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "tandem/base/error.h"
#include "tandem/compile/binary_tree.h"
#include "tandem/kernel/traversal/collapse.h"
#include "tandem/kernel/traversal/make_node.h"

namespace tandem {

namespace {

/// A binary tree with the costs by which wide_children() chooses.
class WeighedTree {
  public:
    explicit WeighedTree(const BinaryTree& tree) : nodes_(tree.nodes), forests_(nodes_.size()) {
        const double whole = wide_half_area(nodes_[0].box);
        for (std::size_t i = nodes_.size(); i-- > 0;) {
            const auto index = static_cast<std::uint32_t>(i);
            const float area = relative_area(nodes_[i].box, whole);
            forests_[i] = is_leaf(index) ? forests_of_leaf(area)
                                         : forests_of_node(area, forests_[first(index)], forests_[second(index)]);
        }
    }
    [[nodiscard]] const Forests& forests(std::uint32_t node) const { return forests_[node]; }
    [[nodiscard]] std::uint32_t first(std::uint32_t node) const { return node + 1; }
    [[nodiscard]] std::uint32_t second(std::uint32_t node) const { return nodes_[node].second; }
    [[nodiscard]] bool is_leaf(std::uint32_t node) const { return nodes_[node].is_leaf(); }

  private:
    const std::vector<BinaryNode>& nodes_;
    std::vector<Forests> forests_;
};

class BvhBuilder {
  public:
    BvhBuilder(const SceneView& scene, const Padding& padding)
        : scene_(scene), tree_(build_binary_tree(scene, padding)), weighed_(tree_) {}

    Bvh run() {
        bvh_.entry_ids.reserve(tree_.order.size() + spare_entries);
        bvh_.entry_spheres.reserve(tree_.order.size() + spare_entries);
        std::vector<std::uint32_t> binary = {0};  // for each node, the one that it replaces
        for (std::size_t i = 0; i < binary.size(); ++i) add_node(binary[i], binary);
        for (int i = 0; i < spare_entries; ++i) add_entry(bvh_.entry_ids.back());
        if (!placed_by_entry(scene_)) {
            add_placements(std::span(scene_.ellipsoids, scene_.ellipsoid_count));
            add_placements(std::span(scene_.parallelepipeds, scene_.parallelepiped_count));
        }
        return std::move(bvh_);
    }

  private:
    template <class Body>
    void add_placements(std::span<const Body> bodies) {
        for (const Body& body : bodies) bvh_.placements.push_back(rough_placement(body));
    }

    void add_node(std::uint32_t index, std::vector<std::uint32_t>& binary) {
        const WideChildren list = wide_children(weighed_, index);
        std::vector<std::uint32_t> children(list.node, list.node + list.count);
        const auto first_leaf = std::stable_partition(
            children.begin(), children.end(), [&](std::uint32_t child) { return !tree_.nodes[child].is_leaf(); });
        std::array<Aabb, bvh_width> boxes;
        for (std::size_t i = 0; i < children.size(); ++i) boxes[i] = tree_.nodes[children[i]].box;
        bvh_.nodes.push_back(make_node(boxes.data(), list.count, static_cast<int>(first_leaf - children.begin()),
                                       static_cast<std::int32_t>(binary.size()),
                                       static_cast<std::int32_t>(bvh_.entry_ids.size())));
        for (const std::uint32_t child : children) {
            if (tree_.nodes[child].is_leaf()) {
                add_entry(tree_.order[tree_.nodes[child].first_primitive]);
            } else {
                binary.push_back(child);
            }
        }
    }

    void add_entry(std::uint32_t id) {
        bvh_.entry_ids.push_back(id);
        if (scene_.triangle_count == tree_.order.size()) {
            bvh_.entry_triangles.push_back(entry_triangle(scene_.triangles[id], id));
        }
        if (placed_by_entry(scene_)) bvh_.placements.push_back(rough_placement(scene_.parallelepipeds[id]));
        visit_primitive(scene_, id,
                        [&](const auto& primitive) { bvh_.entry_spheres.push_back(sphere_around(primitive)); });
    }

    const SceneView& scene_;
    BinaryTree tree_;
    WeighedTree weighed_;
    Bvh bvh_;
};

}  // namespace

void check_bvh_size(std::uint32_t primitives) {
    if (primitives <= max_bvh_primitives) return;
    throw InputError(
        fmt::format("the scene has {} primitives; the BVH takes {} at most", primitives, max_bvh_primitives));
}

Bvh build_bvh(const SceneView& scene, const Padding& padding) {
    check_bvh_size(primitive_count(scene));
    return BvhBuilder(scene, padding).run();
}

}  // namespace tandem
