#include "tandem/compile/mesh_extent.h"

#include <algorithm>
#include <array>
#include <limits>

#include "tandem/compile/child_box.h"

namespace tandem {

namespace {

/// A share of the extent along a direction: a box that reaches no more than this beyond the farthest corner stays
/// closed.
constexpr double slack = 1.0 / 16;

}  // namespace

MeshExtent::Range MeshExtent::under(const Matrix3& linear) const {
    const auto upper = [&](int axis) { return along(linear.row[axis]); };
    const auto lower = [&](int axis) { return -along(-linear.row[axis]); };
    return {{lower(0), lower(1), lower(2)}, {upper(0), upper(1), upper(2)}};
}

double MeshExtent::along(const Vec3d& direction) const {
    struct Place {
        double most;  ///< that a corner below may reach
        std::int32_t child;
    };
    const auto most_of = [&](const ChildBox& box) {
        const auto on_axis = [](double d, double lower, double upper) { return d * (d < 0 ? lower : upper); };
        return on_axis(direction.x, box.lower.x, box.upper.x) + on_axis(direction.y, box.lower.y, box.upper.y) +
               on_axis(direction.z, box.lower.z, box.upper.z);
    };
    double farthest = -std::numeric_limits<double>::infinity();  // corner so far
    double bound = farthest;  // of the boxes that were not opened, because they reach barely farther
    double enough = 0;
    std::array<Place, static_cast<std::size_t>(bvh_stack_size)> stack;
    stack[0] = {std::numeric_limits<double>::infinity(), 0};
    for (std::size_t depth = 1; depth > 0;) {
        const Place place = stack[--depth];
        if (place.most <= farthest + enough) {
            bound = std::max(bound, place.most);
            continue;
        }
        if (place.child < 0) {
            const Triangle& face = faces_[bvh_.entry_ids[static_cast<std::uint32_t>(~place.child)]];
            for (const Vec3f* corner : {&face.v0, &face.v1, &face.v2}) {
                farthest = std::max(farthest, dot(direction, widen(*corner) - centre_));
            }
            continue;
        }
        const BvhNode& node = bvh_.nodes[static_cast<std::size_t>(place.child)];
        const std::size_t first = depth;
        for (unsigned i = 0; i < bvh_width; ++i) {
            const ChildBox box = child_box(node, i);
            if (is_empty(box)) continue;
            const double most = most_of(box);
            if (place.child == 0) enough = std::max(enough, most * slack);
            // the farthest on top
            std::size_t at = depth++;
            for (; at > first && stack[at - 1].most > most; --at) stack[at] = stack[at - 1];
            stack[at] = {most, child_of(node, static_cast<std::int32_t>(i))};
        }
    }
    return std::max(farthest, bound);
}

}  // namespace tandem
