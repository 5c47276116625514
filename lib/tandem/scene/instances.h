/// The shapes of a scene in one numbering, so that threads can take ranges of them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "tandem/scene/scene.h"

namespace tandem {

/// The shapes of one geometry: one per instance, or one at its node.
struct InstanceRange {
    const Geometry* geometry;
    std::size_t node;
    std::size_t first;  ///< the number of its first shape; ranges follow each other without gaps
};

[[nodiscard]] inline std::size_t instance_count(const Geometry& geometry) {
    return std::max<std::size_t>(1, geometry.instances.size());
}

/// Calls visit(range, world_from_shape) for the shapes whose numbers are from `begin` up to, but not including, `end`,
/// in their order. `ranges`: InstanceRange or derived from it, in their order; `world_from_node`: by node.
template <class Range, class Visit>
void visit_instances(const std::vector<Range>& ranges, std::span<const Transform> world_from_node, std::size_t begin,
                     std::size_t end, const Visit& visit) {
    const auto is_after = [](std::size_t number, const Range& range) { return number < range.first; };
    auto range = std::upper_bound(ranges.begin(), ranges.end(), begin, is_after) - 1;
    for (std::size_t number = begin; number < end; ++range) {
        const std::vector<Trs>& instances = range->geometry->instances;
        const Transform& at_node = world_from_node[range->node];
        const std::size_t end_of_range = std::min(end, range->first + instance_count(*range->geometry));
        for (; number < end_of_range; ++number) {
            if (instances.empty()) {
                visit(*range, at_node);
            } else {
                visit(*range, at_node * to_transform(instances[number - range->first]));
            }
        }
    }
}

}  // namespace tandem
