#include "cpu/size_layers.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <cstdint>

#include "tandem/kernel/traversal/proposal.h"
#include "tandem/math/fp_environment.h"

namespace tandem {

namespace {

constexpr std::size_t most_layers = 4;

Aabb bounds_of(const SceneView& scene, const SizeRange& sizes) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::uint32_t>(0, primitive_count(scene), 4096), Aabb{},
        [&](const tbb::blocked_range<std::uint32_t>& range, Aabb all) {
            const DefaultFpEnvironment guard;
            for (std::uint32_t id = range.begin(); id < range.end(); ++id) {
                const Aabb box = primitive_bounds(scene, id);
                if (sizes.contains(box)) all = merge(all, box);
            }
            return all;
        },
        [](const Aabb& a, const Aabb& b) { return merge(a, b); });
}

/// Whether, of up to 16,384 primitives at equal steps through the list, at least one in 64 of those in `all` is in
/// `part`. A guess, which affects only the speed.
bool are_many(const SceneView& scene, const SizeRange& part, const SizeRange& all) {
    constexpr std::uint32_t most = 16'384;
    const std::uint32_t count = primitive_count(scene), step = (count - 1) / most + 1;
    std::uint32_t in_all = 0, in_part = 0;
    for (std::uint32_t id = 0; id < count; id += step) {
        const Aabb box = primitive_bounds(scene, id);
        in_all += all.contains(box) ? 1 : 0;
        in_part += part.contains(box) ? 1 : 0;
    }
    return in_part > 0 && 64 * in_part >= in_all;
}

}  // namespace

std::vector<SizeLayer> divide_by_size(const SceneView& scene) {
    std::vector<SizeLayer> layers = {{{}, bounds_of(scene, {})}};
    while (layers.size() < most_layers) {
        SizeLayer& last = layers.back();
        // the padded box of a primitive of this size has 2.25 times the area
        const SizeRange tiny = {0, 4 * make_structure_frame(last.bounds, BoxErrors::of_scene).padding.least};
        if (!are_many(scene, tiny, last.sizes)) break;
        const Aabb bounds = bounds_of(scene, tiny);
        if (!(reach(bounds) < 0.5F * reach(last.bounds))) break;
        last.sizes.least = tiny.below;
        layers.push_back({tiny, bounds});
    }
    return layers;
}

}  // namespace tandem
