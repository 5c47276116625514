#include "tandem/compile/build_bvh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "tandem/base/error.h"

namespace tandem {

namespace {

constexpr int bin_count = 16;
constexpr std::uint32_t preferred_leaf_size = 2;
/// Below this depth ranges are halved, which ends within log2(max_bvh_primitives) = 28 more levels.
constexpr int sah_depth = max_bvh_depth - 30;

float component(const Vec3f& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

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

struct Bin {
    Aabb box;
    std::uint32_t count = 0;
};

class Builder {
  public:
    Builder(const SceneView& scene, float margin) : scene_(scene) {
        const std::uint32_t count = primitive_count(scene);
        boxes_.reserve(count);
        for (std::uint32_t id = 0; id < count; ++id) boxes_.push_back(pad(primitive_bounds(scene, id), margin));
        order_.resize(count);
        std::iota(order_.begin(), order_.end(), 0U);
    }

    Bvh run() {
        Range all = {0, static_cast<std::uint32_t>(order_.size()), 0};
        if (all.size() == 1) {  // a root has two children; an empty box is never entered
            bvh_.nodes.emplace_back();
            set_child(0, 0, boxes_[order_[0]], leaf_child(0, 1));
            set_child(0, 1, Aabb{}, leaf_child(0, 1));
        } else {
            build_node(all);
        }
        bvh_.entry_ids = order_;
        for (const std::uint32_t id : order_) bvh_.entry_spheres.push_back(bounding_sphere(id));
        return std::move(bvh_);
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

    /// Builds an inner node over at least two primitives; returns its index.
    std::int32_t build_node(const Range& range) {
        const auto index = static_cast<std::int32_t>(bvh_.nodes.size());
        bvh_.nodes.emplace_back();
        const std::uint32_t middle = split(range);
        const Range halves[2] = {{range.first, middle, range.depth + 1}, {middle, range.end, range.depth + 1}};
        for (int side = 0; side < 2; ++side) {
            const Range& half = halves[side];
            const Aabb box = bounds_of(half);
            const std::int32_t child =
                half.size() <= preferred_leaf_size ? leaf_child(half.first, half.size()) : build_node(half);
            set_child(static_cast<std::size_t>(index), side, box, child);
        }
        return index;
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

    void set_child(std::size_t node, int side, const Aabb& box, std::int32_t child) {
        BvhNode& n = bvh_.nodes[node];
        const auto s = static_cast<std::size_t>(side);
        n.xy[s][0] = box.lower.x;
        n.xy[s][1] = box.upper.x;
        n.xy[s][2] = box.lower.y;
        n.xy[s][3] = box.upper.y;
        n.z[2 * s] = box.lower.z;
        n.z[2 * s + 1] = box.upper.z;
        n.child[s] = child;
    }

    Sphere bounding_sphere(std::uint32_t id) const {
        Sphere sphere{};
        visit_primitive(scene_, id, [&](const auto& primitive) { sphere = sphere_around(primitive); });
        return sphere;
    }

    const SceneView& scene_;
    std::vector<Aabb> boxes_;
    std::vector<std::uint32_t> order_;
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
