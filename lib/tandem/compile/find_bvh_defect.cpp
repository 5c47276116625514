#include <fmt/format.h>

#include "tandem/compile/build_bvh.h"
#include "tandem/compile/child_box.h"

namespace tandem {

namespace {

bool contains(const ChildBox& outer, const Aabb& inner) {
    return outer.lower.x <= inner.lower.x && outer.lower.y <= inner.lower.y && outer.lower.z <= inner.lower.z &&
           outer.upper.x >= inner.upper.x && outer.upper.y >= inner.upper.y && outer.upper.z >= inner.upper.z;
}

class Inspector {
  public:
    Inspector(const Bvh& bvh, const SceneView& scene, const Padding& padding)
        : bvh_(bvh), scene_(scene), padding_(padding), seen_(primitive_count(scene), 0) {}

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
        return pad(primitive_bounds(scene_, id), padding_);
    }

    const Bvh& bvh_;
    const SceneView& scene_;
    Padding padding_;
    std::vector<int> seen_;
    std::string defect_;
};

}  // namespace

std::string find_bvh_defect(const Bvh& bvh, const SceneView& scene, const Padding& padding) {
    return Inspector(bvh, scene, padding).run();
}

}  // namespace tandem
