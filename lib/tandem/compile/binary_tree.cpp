#include "tandem/compile/binary_tree.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace tandem {

namespace {

constexpr int bin_count = 16;
/// Below this depth ranges are halved, which ends within log2(max_bvh_primitives) = 30 more levels.
constexpr int sah_depth = max_bvh_depth - 32;

float component(const Vec3f& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

struct Bin {
    Aabb box;
    std::uint32_t count = 0;
};

class Builder {
  public:
    explicit Builder(std::vector<Aabb> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
        std::iota(order_.begin(), order_.end(), 0U);
    }

    BinaryTree run() {
        tree_.nodes.reserve(2 * order_.size() - 1);
        build_node({0, static_cast<std::uint32_t>(order_.size()), 0});
        tree_.order = std::move(order_);
        return std::move(tree_);
    }

  private:
    struct Range {
        std::uint32_t first, end;
        int depth;
        [[nodiscard]] std::uint32_t size() const { return end - first; }
    };

    struct Split {
        float cost = 3.4e38F;
        int axis = -1;
        int bin = 0;
        float lower = 0, scale = 0;
        [[nodiscard]] int bin_of(const Vec3f& centre) const {
            return std::min(bin_count - 1, static_cast<int>((component(centre, axis) - lower) * scale));
        }
    };

    Aabb bounds_of(const Range& range) const {
        Aabb box;
        for (std::uint32_t i = range.first; i < range.end; ++i) box = merge(box, boxes_[order_[i]]);
        return box;
    }

    /// Builds the nodes over a range, which must not be empty.
    void build_node(const Range& range) {
        const std::size_t index = tree_.nodes.size();
        tree_.nodes.push_back({bounds_of(range), 0, range.first});
        if (range.size() == 1) return;
        const std::uint32_t middle = split(range);
        build_node({range.first, middle, range.depth + 1});
        tree_.nodes[index].second = static_cast<std::uint32_t>(tree_.nodes.size());
        build_node({middle, range.end, range.depth + 1});
    }

    /// Reorders the range; returns where its second half begins.
    std::uint32_t split(const Range& range) {
        const auto first = order_.begin() + range.first;
        const auto end = order_.begin() + range.end;
        const Split best = range.depth < sah_depth ? best_split(range) : Split{};
        if (best.axis >= 0) {
            const auto middle = std::partition(
                first, end, [&](std::uint32_t id) { return best.bin_of(centre(boxes_[id])) <= best.bin; });
            if (middle != first && middle != end) return static_cast<std::uint32_t>(middle - order_.begin());
        }
        return range.first + range.size() / 2;  // centres coincide, or the tree is deep: halve by number
    }

    Split best_split(const Range& range) const {
        Aabb centres;
        for (std::uint32_t i = range.first; i < range.end; ++i) {
            const Vec3f c = centre(boxes_[order_[i]]);
            centres = merge(centres, {c, c});
        }
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            const float extent = component(centres.upper, axis) - component(centres.lower, axis);
            if (!(extent > 0)) continue;
            Split candidate;
            candidate.axis = axis;
            candidate.lower = component(centres.lower, axis);
            candidate.scale = static_cast<float>(bin_count) / extent;
            if (!(candidate.scale < 3e38F)) continue;
            evaluate(range, candidate);
            if (candidate.cost < best.cost) best = candidate;
        }
        return best;
    }

    /// Finds the cheapest plane between the bins along candidate.axis.
    void evaluate(const Range& range, Split& candidate) const {
        std::array<Bin, bin_count> bins;
        for (std::uint32_t i = range.first; i < range.end; ++i) {
            const Aabb& box = boxes_[order_[i]];
            Bin& bin = bins[static_cast<std::size_t>(candidate.bin_of(centre(box)))];
            bin.box = merge(bin.box, box);
            ++bin.count;
        }
        std::array<float, bin_count> cost_above{};
        Bin above;
        const auto cost = [](const Bin& b) {
            return b.count == 0 ? 0.0F : half_area(b.box) * static_cast<float>(b.count);
        };
        for (std::size_t i = bin_count - 1; i > 0; --i) {
            above = {merge(above.box, bins[i].box), above.count + bins[i].count};
            cost_above[i - 1] = cost(above);
        }
        Bin below;
        for (std::size_t i = 0; i + 1 < bin_count; ++i) {
            below = {merge(below.box, bins[i].box), below.count + bins[i].count};
            const float total = cost(below) + cost_above[i];
            if (below.count > 0 && below.count < range.size() && total < candidate.cost) {
                candidate.cost = total;
                candidate.bin = static_cast<int>(i);
            }
        }
    }

    std::vector<Aabb> boxes_;
    std::vector<std::uint32_t> order_;
    BinaryTree tree_;
};

}  // namespace

BinaryTree build_binary_tree(std::vector<Aabb> boxes) { return Builder(std::move(boxes)).run(); }

BinaryTree build_binary_tree(const SceneView& scene, const Padding& padding) {
    const std::uint32_t count = primitive_count(scene);
    std::vector<Aabb> boxes;
    boxes.reserve(count);
    for (std::uint32_t id = 0; id < count; ++id) boxes.push_back(pad(primitive_bounds(scene, id), padding));
    return build_binary_tree(std::move(boxes));
}

}  // namespace tandem
