#include "tandem/compile/build_bvh.h"

#include <fmt/format.h>

#include <cmath>

namespace tandem {

namespace {

/// What node_ray.h takes for a child's box, in exact arithmetic, without the part of a step that rounding needs.
struct ChildBox {
    Vec3d lower, upper;
};

ChildBox child_box(const BvhNode& node, unsigned child) {
    const auto plane = [&](unsigned axis, std::uint32_t planes, double inward) {
        const double step = std::ldexp(1.0, static_cast<int>(node.frame >> (8 * axis) & 255U) - 127 - 7);
        const double exact = node.corner[axis] + step * (planes >> (8 * child) & 255U);
        return exact + inward * step * 0x1p-8;
    };
    return {{plane(0, node.lower_x, 1), plane(1, node.lower_y, 1), plane(2, node.lower_z, 1)},
            {plane(0, node.upper_x, -1), plane(1, node.upper_y, -1), plane(2, node.upper_z, -1)}};
}

bool is_empty(const ChildBox& box) { return box.lower.x > box.upper.x; }

bool contains(const ChildBox& outer, const Aabb& inner) {
    return outer.lower.x <= inner.lower.x && outer.lower.y <= inner.lower.y && outer.lower.z <= inner.lower.z &&
           outer.upper.x >= inner.upper.x && outer.upper.y >= inner.upper.y && outer.upper.z >= inner.upper.z;
}

class Inspector {
  public:
    Inspector(const Bvh& bvh, const SceneView& scene, float margin)
        : bvh_(bvh), scene_(scene), margin_(margin), seen_(primitive_count(scene), 0) {}

    std::string run() {
        (void)inspect(0, 1);
        for (std::size_t id = 0; id < seen_.size() && defect_.empty(); ++id) {
            if (seen_[id] != 1) defect_ = fmt::format("primitive {} is there {} times", id, seen_[id]);
        }
        return defect_;
    }

  private:
    /// Returns the bounds of the primitives below.
    Aabb inspect(std::int32_t index, int depth) {
        if (depth > max_bvh_depth) defect_ = fmt::format("node {} is at depth {}", index, depth);
        if (index < 0 || static_cast<std::size_t>(index) >= bvh_.nodes.size()) {
            defect_ = fmt::format("there is no node {}", index);
        }
        Aabb all;
        if (!defect_.empty()) return all;
        const BvhNode& node = bvh_.nodes[static_cast<std::size_t>(index)];
        for (unsigned child = 0; child < bvh_width && defect_.empty(); ++child) {
            const ChildBox box = child_box(node, child);
            const std::int32_t code = child_of(node, static_cast<std::int32_t>(child));
            const bool is_there = !is_empty(box);
            const Aabb below = code < 0 ? inspect_entry(~code, is_there) : is_there ? inspect(code, depth + 1) : Aabb{};
            if (!defect_.empty() || !is_there) continue;
            if (!contains(box, below)) defect_ = fmt::format("child {} of node {} sticks out of its box", child, index);
            all = merge(all, below);
        }
        return all;
    }

    Aabb inspect_entry(std::int32_t entry, bool is_there) {
        const auto i = static_cast<std::size_t>(entry);
        if (i >= bvh_.entry_ids.size() || i >= bvh_.entry_spheres.size() || bvh_.entry_ids[i] >= seen_.size()) {
            defect_ = fmt::format("a node names entry {}, which does not exist", i);
            return {};
        }
        const std::uint32_t id = bvh_.entry_ids[i];
        if (is_there) ++seen_[id];
        return pad(primitive_bounds(scene_, id), margin_);
    }

    const Bvh& bvh_;
    const SceneView& scene_;
    float margin_;
    std::vector<int> seen_;
    std::string defect_;
};

}  // namespace

std::string find_bvh_defect(const Bvh& bvh, const SceneView& scene, float margin) {
    return Inspector(bvh, scene, margin).run();
}

}  // namespace tandem
