#include "tandem/compile/build_bvh.h"

#include <fmt/format.h>

namespace tandem {

namespace {

Aabb child_box(const BvhNode& node, std::size_t side) {
    return {{node.xy[side][0], node.xy[side][2], node.z[2 * side]},
            {node.xy[side][1], node.xy[side][3], node.z[2 * side + 1]}};
}

bool contains(const Aabb& outer, const Aabb& inner) {
    return is_empty(inner) ||
           (outer.lower.x <= inner.lower.x && outer.lower.y <= inner.lower.y && outer.lower.z <= inner.lower.z &&
            outer.upper.x >= inner.upper.x && outer.upper.y >= inner.upper.y && outer.upper.z >= inner.upper.z);
}

class Inspector {
  public:
    Inspector(const Bvh& bvh, const SceneView& scene, float margin)
        : bvh_(bvh), scene_(scene), margin_(margin), seen_(primitive_count(scene), 0) {}

    std::string run() {
        inspect(0, 1, nullptr);
        for (std::size_t id = 0; id < seen_.size() && defect_.empty(); ++id) {
            if (seen_[id] != 1) defect_ = fmt::format("primitive {} is in {} leaves", id, seen_[id]);
        }
        return defect_;
    }

  private:
    void inspect(std::int32_t index, int depth, const Aabb* outer) {
        if (depth > max_bvh_depth) defect_ = fmt::format("node {} is at depth {}", index, depth);
        if (index < 0 || static_cast<std::size_t>(index) >= bvh_.nodes.size()) {
            defect_ = fmt::format("there is no node {}", index);
        }
        if (!defect_.empty()) return;
        const BvhNode& node = bvh_.nodes[static_cast<std::size_t>(index)];
        for (std::size_t side = 0; side < 2; ++side) {
            const Aabb box = child_box(node, side);
            if (is_empty(box)) continue;  // never entered
            if (outer != nullptr && !contains(*outer, box)) {
                defect_ = fmt::format("child {} of node {} leaves the box of its parent", side, index);
            }
            if (!defect_.empty()) return;
            if (node.child[side] >= 0) {
                inspect(node.child[side], depth + 1, &box);
            } else {
                inspect_leaf(node.child[side], box);
            }
        }
    }

    void inspect_leaf(std::int32_t child, const Aabb& box) {
        for (std::uint32_t i = leaf_first(child); i < leaf_first(child) + leaf_count(child); ++i) {
            if (i >= bvh_.entry_ids.size() || bvh_.entry_ids[i] >= seen_.size()) {
                defect_ = fmt::format("a leaf names entry {}, which does not exist", i);
                return;
            }
            const std::uint32_t id = bvh_.entry_ids[i];
            ++seen_[id];
            if (!contains(box, pad(primitive_bounds(scene_, id), margin_))) {
                defect_ = fmt::format("primitive {} sticks out of its leaf", id);
            }
        }
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
