#include "tandem/compile/build_bvh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "tandem/base/error.h"
#include "tandem/compile/binary_tree.h"

namespace tandem {

namespace {

/// The smallest sphere around `middle` that contains all points.
template <class... Points>
Sphere sphere_to(const Vec3f& middle, const Points&... points) {
    double radius2 = 0;
    const auto reach_for = [&](const Vec3f& point) {
        const Vec3d offset = widen(point) - widen(middle);
        radius2 = std::max(radius2, dot(offset, offset));
    };
    (reach_for(points), ...);
    return {middle, round_up(square_root(radius2) * (1 + 1e-15))};
}

Sphere sphere_around(const Sphere& sphere) { return sphere; }
Sphere sphere_around(const Placement& body) { return body.bounding_sphere; }
Sphere sphere_around(const Box& box) {
    const Vec3f middle = (box.lower + box.upper) * 0.5F;
    const Vec3d lower = widen(middle) - widen(box.lower);
    const Vec3d upper = widen(box.upper) - widen(middle);
    const Vec3d far = {std::max(lower.x, upper.x), std::max(lower.y, upper.y), std::max(lower.z, upper.z)};
    return {middle, round_up(square_root(dot(far, far)) * (1 + 1e-15))};
}
Sphere sphere_around(const Triangle& t) { return sphere_to(centre(bounds(t)), t.v0, t.v1, t.v2); }
Sphere sphere_around(const Quad& q) { return sphere_to(centre(bounds(q)), q.v0, q.v1, q.v2, q.v3); }

/// Which nodes of a binary tree become the children of a wide node, by the surface area heuristic. The cost of a node
/// with k places is that of the cheapest forest of k wide trees over its primitives.
/// Source: Ylitie et al. (kernel/traversal/bvh.h), section 3.1.
class Collapse {
  public:
    explicit Collapse(const BinaryTree& tree) : nodes_(tree.nodes), places_(nodes_.size()) {
        // relative to the root, and in double, so that they are numbers in scenes of any size
        const double whole = std::max(area_of(nodes_[0].box), 1e-300);
        for (std::size_t i = nodes_.size(); i-- > 0;) {
            weigh(i, static_cast<float>(std::min(area_of(nodes_[i].box) / whole, 1.0)));
        }
    }

    /// The children of the wide node that replaces binary node `index`: at least two, at most bvh_width.
    [[nodiscard]] std::vector<std::uint32_t> children(std::uint32_t index) const {
        if (nodes_[index].is_leaf()) return {index};
        std::vector<std::uint32_t> list;
        divide(index, bvh_width, list);
        return list;
    }

  private:
    static constexpr float leaf_cost = 0.6F;  ///< of a primitive, relative to that of a node

    /// By number of places - 1.
    struct Places {
        std::array<float, bvh_width - 1> cost;
        std::array<std::uint8_t, bvh_width> for_first;  ///< how many go to the first child; 0: the last place is unused
    };

    static double area_of(const Aabb& box) {
        const Vec3d extent = widen(box.upper) - widen(box.lower);
        return extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
    }

    void weigh(std::size_t index, float area) {
        Places& at = places_[index];
        at.for_first.fill(0);
        if (nodes_[index].is_leaf()) {
            at.cost.fill(area * leaf_cost);
            return;
        }
        const auto cheapest = [&](std::size_t places) {
            float least = 0;
            for (std::size_t first = 1; first < places; ++first) {
                const float cost =
                    places_[index + 1].cost[first - 1] + places_[nodes_[index].second].cost[places - first - 1];
                if (first > 1 && !(cost < least)) continue;
                least = cost;
                at.for_first[places - 1] = static_cast<std::uint8_t>(first);
            }
            return least;
        };
        at.cost[0] = cheapest(bvh_width) + area;
        for (std::size_t places = 2; places < bvh_width; ++places) {
            const float divided = cheapest(places);
            const float undivided = at.cost[places - 2];
            if (!(divided < undivided)) at.for_first[places - 1] = 0;
            at.cost[places - 1] = std::min(divided, undivided);
        }
    }

    void divide(std::uint32_t index, std::size_t places, std::vector<std::uint32_t>& list) const {
        const Places& at = places_[index];
        while (places > 1 && at.for_first[places - 1] == 0) --places;
        if (places == 1) {
            list.push_back(index);
            return;
        }
        const std::size_t first = at.for_first[places - 1];
        divide(index + 1, first, list);
        divide(nodes_[index].second, places - first, list);
    }

    const std::vector<BinaryNode>& nodes_;
    std::vector<Places> places_;
};

/// One axis of a node's grid: corner + 2^exponent * byte.
struct Axis {
    float corner;
    int exponent;

    /// The finest grid whose bytes reach from `lower` to `upper`, with 1/32 step to spare (node_ray.h needs 2^-8).
    Axis(float lower, float upper) {
        const double extent = static_cast<double>(upper) - lower;
        exponent = std::max(least_step_exponent, std::ilogb(std::max(extent / 255, 1e-300)) - 1);
        while (!try_exponent(lower, upper)) ++exponent;
    }
    [[nodiscard]] std::uint32_t below(float plane) const { return byte(std::floor(steps_to(plane) - spare)); }
    [[nodiscard]] std::uint32_t above(float plane) const { return byte(std::ceil(steps_to(plane) + spare)); }

  private:
    static constexpr double spare = 1.0 / 32;

    bool try_exponent(float lower, float upper) {
        corner = round_sum_down(lower, -std::ldexp(2 * spare, exponent));
        return std::ceil(steps_to(upper) + spare) <= 255;
    }
    [[nodiscard]] double steps_to(float plane) const {
        return std::ldexp(static_cast<double>(plane) - corner, -exponent);
    }
    static std::uint32_t byte(double steps) { return static_cast<std::uint32_t>(std::clamp(steps, 0.0, 255.0)); }
};

class Builder {
  public:
    Builder(const SceneView& scene, float margin)
        : scene_(scene), tree_(build_binary_tree(scene, margin)), collapse_(tree_) {}

    Bvh run() {
        bvh_.entry_ids.reserve(tree_.order.size() + spare_entries);
        bvh_.entry_spheres.reserve(tree_.order.size() + spare_entries);
        std::vector<std::uint32_t> binary = {0};  // for each node, the one that it replaces
        for (std::size_t i = 0; i < binary.size(); ++i) add_node(binary[i], binary);
        for (int i = 0; i < spare_entries; ++i) add_entry(bvh_.entry_ids.back());
        add_placements(std::span(scene_.ellipsoids, scene_.ellipsoid_count));
        add_placements(std::span(scene_.parallelepipeds, scene_.parallelepiped_count));
        return std::move(bvh_);
    }

  private:
    template <class Body>
    void add_placements(std::span<const Body> bodies) {
        for (const Body& body : bodies) bvh_.placements.push_back(rough_placement(body));
    }

    void add_node(std::uint32_t index, std::vector<std::uint32_t>& binary) {
        std::vector<std::uint32_t> children = collapse_.children(index);
        const auto first_leaf = std::stable_partition(
            children.begin(), children.end(), [&](std::uint32_t child) { return !tree_.nodes[child].is_leaf(); });
        const auto inner = static_cast<std::int32_t>(first_leaf - children.begin());
        BvhNode node{};
        set_planes(children, node);
        node.frame |= static_cast<std::uint32_t>(inner) << 24;
        node.first_inner = static_cast<std::int32_t>(binary.size());
        node.leaf_base = inner - 1 - static_cast<std::int32_t>(bvh_.entry_ids.size());
        for (const std::uint32_t child : children) {
            if (tree_.nodes[child].is_leaf()) {
                add_entry(tree_.order[tree_.nodes[child].first_primitive]);
            } else {
                binary.push_back(child);
            }
        }
        bvh_.nodes.push_back(node);
    }

    void set_planes(const std::vector<std::uint32_t>& children, BvhNode& node) const {
        Aabb all;
        for (const std::uint32_t child : children) all = merge(all, tree_.nodes[child].box);
        const auto set_axis = [&](unsigned axis, float Vec3f::*of, std::uint32_t& lower, std::uint32_t& upper) {
            const Axis grid(all.lower.*of, all.upper.*of);
            node.corner[axis] = grid.corner;
            node.frame |= frame_exponent(grid.exponent) << (8 * axis);
            lower = 0xFFFFFFFFU;  // empty
            for (std::size_t i = 0; i < children.size(); ++i) {
                const Aabb& box = tree_.nodes[children[i]].box;
                lower = (lower & ~(0xFFU << (8 * i))) | grid.below(box.lower.*of) << (8 * i);
                upper |= grid.above(box.upper.*of) << (8 * i);
            }
        };
        set_axis(0, &Vec3f::x, node.lower_x, node.upper_x);
        set_axis(1, &Vec3f::y, node.lower_y, node.upper_y);
        set_axis(2, &Vec3f::z, node.lower_z, node.upper_z);
    }

    void add_entry(std::uint32_t id) {
        bvh_.entry_ids.push_back(id);
        if (scene_.triangle_count == tree_.order.size()) {
            const Triangle& t = scene_.triangles[id];
            bvh_.entry_triangles.push_back({t.v0, t.v1, t.v2, id, t.attributes.sides, 0});
        }
        visit_primitive(scene_, id,
                        [&](const auto& primitive) { bvh_.entry_spheres.push_back(sphere_around(primitive)); });
    }

    const SceneView& scene_;
    BinaryTree tree_;
    Collapse collapse_;
    Bvh bvh_;
};

}  // namespace

Bvh build_bvh(const SceneView& scene, float margin) {
    const std::uint32_t count = primitive_count(scene);
    if (count > max_bvh_primitives) {
        throw InputError(
            fmt::format("the scene has {} primitives; the BVH takes {} at most", count, max_bvh_primitives));
    }
    return Builder(scene, margin).run();
}

}  // namespace tandem
