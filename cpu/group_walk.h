/// The traversal of the hierarchy of groups by one ray.
#pragma once

#include "cpu/group_filter.h"
#include "cpu/group_nodes.h"
#include "tandem/kernel/traversal/node_ray.h"

namespace tandem {

/// The most nodes above a group: make_groups() makes trees of at most one less, and joins them.
inline constexpr int group_depth = 33;

/// Bound of the slab tests plane / d - origin / d, with S = reach of the scene's bounds and u = 2^-24. As lengths, the
/// two terms err by 4 u S each because of the reciprocal (rough_reciprocal()) and by u S because they are rounded, and
/// the difference is rounded to 2 u S. So 12 u S, which the padding of the boxes covers (proposal.h). Nothing
/// overflows: S < 1e19, and 1 / d < 1e19 (make_node_ray()). Tested by tests/cpu/group_tracer_test.cpp.
///
/// No code branches on the signs of the direction: they differ from ray to ray, and the traversals of several rays are
/// interleaved.
template <class Isa>
class GroupWalk {
  public:
    /// At the child `root` of the hierarchy. `start`: the least query parameter of interest.
    TANDEM_HD_INLINE void start(const Ray<float>& ray, float start, std::uint32_t root) {
        const NodeRay node_ray = make_node_ray(ray.origin, ray.direction);
        const Vec3f &o = node_ray.origin, &d = node_ray.inverse_direction;
        const float origin[] = {o.x, o.y, o.z}, inverse[] = {d.x, d.y, d.z};
        for (int axis = 0; axis < 3; ++axis) {
            inverse_[axis] = inverse[axis];
            offset_[axis] = -origin[axis] * inverse[axis];
            const auto lower = static_cast<std::uint32_t>(axis), upper = lower + 3;
            nearer_[axis] = inverse[axis] < 0.0F ? upper : lower;
            farther_[axis] = inverse[axis] < 0.0F ? lower : upper;
        }
        start_ = start;
        next_ = root;
        count_ = 0;
    }

    /// The child that the ray is at.
    [[nodiscard]] TANDEM_HD_INLINE std::uint32_t at() const { return next_; }

    /// Goes on to the nearest child that is left and that begins within [start, limit]; false if there is none.
    TANDEM_HD_INLINE bool next(float limit) {
        while (count_ > 0) {
            const Entry entry = stack_[--count_];
            if (distance_of(entry) <= limit) {
                next_ = child_of(entry);
                return true;
            }
        }
        return false;
    }

    /// Goes on to the nearest child of a node that the ray enters within [start, limit], and keeps the others; as
    /// next() if it enters none.
    TANDEM_HD_INLINE bool enter(const GroupNode& node, float limit) {
        alignas(64) float distance[group_node_width];
        unsigned entered = enter_boxes(node, limit, distance);
        if (entered == 0) return next(limit);
        const auto take = [&] {
            const int i = lowest_bit(entered);
            entered &= entered - 1;
            return make_entry(distance[i], node.child[i]);
        };
        // the others are not sorted: sorting takes as long as it saves
        Entry nearest = take();
        while (entered != 0) {  // NOLINT(bugprone-infinite-loop): take() changes it
            const Entry other = take();
            stack_[count_++] = other > nearest ? other : nearest;
            nearest = other < nearest ? other : nearest;
        }
        next_ = child_of(nearest);
        return true;
    }

  private:
    using Lane = Lanes<float, GroupIsa<Isa>>;

    /// A child in the low half, and in the high half the distance at which the ray enters it: floats that are not
    /// negative are ordered as their bits are. So the nearer of two is found without a branch.
    using Entry = std::int64_t;
    TANDEM_HD_INLINE static Entry make_entry(float distance, std::uint32_t child) {
        return static_cast<Entry>(std::uint64_t{bits_of(distance)} << 32 | child);
    }
    TANDEM_HD_INLINE static float distance_of(Entry entry) {
        return float_of(static_cast<std::uint32_t>(static_cast<std::uint64_t>(entry) >> 32));
    }
    TANDEM_HD_INLINE static std::uint32_t child_of(Entry entry) { return static_cast<std::uint32_t>(entry); }

    /// The children that the ray enters, as bits, and the distances at which it enters them.
    TANDEM_HD_INLINE unsigned enter_boxes(const GroupNode& node, float limit, float* distance) const {
        using group_detail::load;
        unsigned entered = 0;
        for (int first = 0; first < group_node_width; first += Lane::size) {
            Lane near(start_), far(limit);
            for (int axis = 0; axis < 3; ++axis) {
                const Lane inverse(inverse_[axis]), offset(offset_[axis]);
                const auto distance_to = [&](std::uint32_t planes) {
                    return loose_multiply_add(load<Lane>(node.plane[planes] + first), inverse, offset);
                };
                near = greater(distance_to(nearer_[axis]), near);
                far = lesser(distance_to(farther_[axis]), far);
            }
            std::memcpy(distance + first, &near, sizeof(near));
            entered |= (near <= far).bits() << first;
        }
        return entered;
    }

    float inverse_[3], offset_[3];
    std::uint32_t nearer_[3], farther_[3];  ///< indices into GroupNode::plane
    float start_;
    std::uint32_t next_;
    int count_;
    Entry stack_[group_depth * (group_node_width - 1) + 1];
};

}  // namespace tandem
