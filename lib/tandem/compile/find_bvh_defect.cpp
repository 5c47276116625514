#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "tandem/compile/build_bvh.h"
#include "tandem/compile/child_box.h"
#include "tandem/kernel/shapes/body_pieces.h"

namespace tandem {

namespace {

bool contains(const ChildBox& outer, const Aabb& inner) {
    return outer.lower.x <= inner.lower.x && outer.lower.y <= inner.lower.y && outer.lower.z <= inner.lower.z &&
           outer.upper.x >= inner.upper.x && outer.upper.y >= inner.upper.y && outer.upper.z >= inner.upper.z;
}

ChildBox intersection(const ChildBox& a, const ChildBox& b) {
    return {{greater(a.lower.x, b.lower.x), greater(a.lower.y, b.lower.y), greater(a.lower.z, b.lower.z)},
            {lesser(a.upper.x, b.upper.x), lesser(a.upper.y, b.upper.y), lesser(a.upper.z, b.upper.z)}};
}

class Inspector {
  public:
    Inspector(const Bvh& bvh, const SceneView& scene, const Padding& padding)
        : bvh_(bvh), scene_(scene), padding_(padding), boxes_(primitive_count(scene)) {}

    std::string run() {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        inspect(0, 1, {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}});
        for (std::uint32_t id = 0; id < boxes_.size() && defect_.empty(); ++id) inspect_primitive(id, boxes_[id]);
        return defect_;
    }

  private:
    /// `around`: what all boxes on the way to the node have in common.
    void inspect(std::int32_t index, int depth, const ChildBox& around) {
        if (depth > max_bvh_depth) defect_ = fmt::format("node {} is at depth {}", index, depth);
        if (index < 0 || static_cast<std::size_t>(index) >= bvh_.nodes.size()) {
            defect_ = fmt::format("there is no node {}", index);
        }
        if (!defect_.empty()) return;
        const BvhNode& node = bvh_.nodes[static_cast<std::size_t>(index)];
        for (unsigned child = 0; child < bvh_width && defect_.empty(); ++child) {
            const ChildBox box = child_box(node, child);
            const std::int32_t code = child_of(node, static_cast<std::int32_t>(child));
            if (code < 0) {
                inspect_entry(~code, box, around);
            } else if (!is_empty(box)) {
                inspect(code, depth + 1, intersection(around, box));
            }
        }
    }

    void inspect_entry(std::int32_t entry, const ChildBox& box, const ChildBox& around) {
        const auto i = static_cast<std::size_t>(entry);
        if (i >= bvh_.entry_ids.size() || i >= bvh_.entry_spheres.size() || bvh_.entry_ids[i] >= boxes_.size()) {
            defect_ = fmt::format("a node names entry {}, which does not exist", i);
        } else if (!is_empty(box)) {
            boxes_[bvh_.entry_ids[i]].push_back(intersection(around, box));
        }
    }

    /// `boxes`: in which traversal finds the primitive. One has to contain it; if it is cut, one has to contain each
    /// piece.
    void inspect_primitive(std::uint32_t id, const std::vector<ChildBox>& boxes) {
        if (boxes.empty()) defect_ = fmt::format("primitive {} is missing", id);
        if (boxes.size() == 1 && !contains(boxes[0], pad(primitive_bounds(scene_, id), padding_))) {
            defect_ = fmt::format("primitive {} sticks out of its boxes", id);
        }
        if (boxes.size() < 2) return;
        visit_primitive(scene_, id, [&]<class Primitive>(const Primitive& primitive) {
            if constexpr (can_have_pieces<Primitive>) {
                if (!cover(boxes, primitive)) {
                    defect_ = fmt::format("primitive {} sticks out of the {} boxes of its pieces", id, boxes.size());
                }
            } else {
                defect_ = fmt::format("primitive {} is there {} times", id, boxes.size());
            }
        });
    }

    /// Whether each of as many pieces of the primitive as there are boxes is in one of them.
    template <class Primitive>
    bool cover(const std::vector<ChildBox>& boxes, const Primitive& primitive) const {
        const Aabb all = bounds(primitive);
        const auto count = static_cast<std::uint32_t>(boxes.size());
        for (std::uint32_t i = 0; i < count; ++i) {
            const Aabb piece = bounds_within(primitive, slab_of_piece(all, i, count));
            const auto has_piece = [&](const ChildBox& box) { return contains(box, pad(piece, padding_)); };
            if (is_empty(piece) || std::none_of(boxes.begin(), boxes.end(), has_piece)) return false;
        }
        return true;
    }

    const Bvh& bvh_;
    const SceneView& scene_;
    Padding padding_;
    std::vector<std::vector<ChildBox>> boxes_;  ///< by primitive
    std::string defect_;
};

}  // namespace

std::string find_bvh_defect(const Bvh& bvh, const SceneView& scene, const Padding& padding) {
    return Inspector(bvh, scene, padding).run();
}

}  // namespace tandem
