#include "cuda/refit_bvh.h"

#include <utility>

#include "cuda/entry_kernels.h"
#include "cuda/leaf_items.h"
#include "tandem/kernel/traversal/collapse.h"

namespace tandem::cuda {

namespace {

/// What a node holds.
struct alignas(16) RefitNode {
    Aabb box;    ///< padded
    float cost;  ///< of the node and all below it, relative to the area of the root
};

/// The nodes of one level, whose children are done.
__global__ void refit_kernel(SceneView scene, TreeArrays to, std::uint32_t begin, std::uint32_t end, Padding padding,
                             double whole, RefitNode* done) {
    const std::uint32_t i = begin + thread_number();
    if (i >= end) return;
    const BvhNode node = to.nodes[i];
    const auto inner = static_cast<int>(inner_count(node));
    Aabb boxes[bvh_width], all;
    float cost = 0;
    int children = 0;
    for (; children < inner; ++children) {
        const RefitNode& below = done[node.first_inner + children];
        boxes[children] = below.box;
        cost += below.cost;
        all = merge(all, below.box);
    }
    for (; children < bvh_width && has_child(node, children); ++children) {
        const auto entry = static_cast<std::uint32_t>(~child_of(node, children));
        const std::uint32_t id = to.ids[entry];
        write_entry(scene, to, entry, id);
        boxes[children] = pad(LeafItems{scene, to.pieces}.bounds(to.pieces != nullptr ? entry : id), padding);
        cost += forests_of_leaf(relative_area(boxes[children], whole)).cost[0];
        all = merge(all, boxes[children]);
    }
    to.nodes[i] = make_node(boxes, children, inner, node.first_inner, inner - 1 - node.leaf_base);
    done[i] = {all, cost + relative_area(all, whole)};
}

}  // namespace

BuiltBvh refit_bvh(const SceneView& scene, const BuiltBvh& built, BuildMemory& memory, cudaStream_t stream) {
    constexpr const char* doing = "refitting a BVH";
    constexpr std::size_t first_node = 256;  // behind the bounds
    static_assert(sizeof(OrderedBounds) <= first_node);
    memory.scratch.reserve(first_node + built.node_count * sizeof(RefitNode));
    memory.word.reserve(sizeof(OrderedBounds));
    auto* const done = reinterpret_cast<RefitNode*>(memory.scratch.data() + first_node);
    auto* const at = reinterpret_cast<OrderedBounds*>(memory.scratch.data());
    const Aabb bounds = scene_bounds(scene, at, memory.word, doing, stream);
    BuiltBvh result = built;
    result.view.frame = make_structure_frame(bounds, BoxErrors::of_distance);
    result.root_area = wide_half_area(pad(bounds, result.view.frame.padding));
    for (std::size_t level = built.levels; level-- > 0;) {
        const std::uint32_t begin = built.level_starts[level], end = built.level_starts[level + 1];
        launch(doing, refit_kernel, (end - begin + build_block - 1) / build_block, build_block, stream, scene,
               built.arrays, begin, end, result.view.frame.padding, result.root_area, done);
    }
    write_rest(scene, built.arrays, built.entry_count, doing, stream);
    RefitNode root;
    fetch_bytes(&root.cost, &done->cost, sizeof(root.cost), memory.word, doing, stream);
    result.cost = widen(root.cost);
    return result;
}

BuiltBvh LastingBvh::of(const SceneView& scene, BuildMemory& memory, cudaStream_t stream, bool allowed) {
    const KindCounts counts = kind_counts(scene);
    // if this throws, there is no hierarchy to refit next time
    const BuiltBvh before = std::exchange(built_, {});
    was_refitted_ = false;
    const bool fits = counts == counts_ && (before.arrays.pieces == nullptr || may_have_pieces(scene));
    if (allowed && before.view.nodes != nullptr && fits) {
        BuiltBvh moved = refit_bvh(scene, before, memory, stream);
        if (!is_worn(moved, before)) {
            built_ = before;
            was_refitted_ = true;
            return moved;
        }
    }
    counts_ = counts;
    built_ = build_bvh(scene, memory, stream, effort_for(primitive_count(scene)));
    return built_;
}

}  // namespace tandem::cuda
