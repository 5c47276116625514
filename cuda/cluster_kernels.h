/// The kernels that make a binary tree over the primitives: build_bvh.h has method and source. Included by
/// build_bvh.cu.
#pragma once

#include "cuda/build_tree.h"
#include "cuda/leaf_items.h"
#include "cuda/scene_bounds.h"

namespace tandem::cuda {

/// The low 21 bits of x, two zeros between each and the next.
__device__ inline std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x001F00000000FFFFULL;
    x = (x | x << 16) & 0x001F0000FF0000FFULL;
    x = (x | x << 8) & 0x100F00F00F00F00FULL;
    x = (x | x << 4) & 0x10C30C30C30C30C3ULL;
    x = (x | x << 2) & 0x1249249249249249ULL;
    return x;
}

/// Cells of the Morton curve along an axis: 2^21. Most scenes need only the coarse cells, of which there are 2^13,
/// since the order within a cell does not matter where primitives are larger than it.
inline constexpr std::uint32_t curve_cells = 1U << 21;
inline constexpr int fine_bits = 8;  ///< per axis, of the place of a cell in a coarse one

/// The cells of a Morton curve: cubes, so that they fit boxes of any shape.
struct CurveCells {
    Vec3f lower;
    double per_metre;

    /// The number of a box's cell along the curve; or, within that cell, of the cell of a curve as fine again.
    [[nodiscard]] __device__ std::uint64_t code(const Aabb& box, bool within) const {
        const auto cell = [&](float a, float b, float from) {
            const double place = ((widen(a) + widen(b)) * 0.5 - widen(from)) * per_metre;
            const double inside = lesser(greater(place, 0.0), curve_cells - 0x1p-21);
            const auto number = static_cast<std::uint64_t>(inside);
            return within ? static_cast<std::uint64_t>((inside - static_cast<double>(number)) * curve_cells) : number;
        };
        return spread(cell(box.lower.x, box.upper.x, lower.x)) << 2 |
               spread(cell(box.lower.y, box.upper.y, lower.y)) << 1 | spread(cell(box.lower.z, box.upper.z, lower.z));
    }
};

static __global__ void codes_kernel(LeafItems items, std::uint32_t count, CurveCells cells, std::uint64_t* codes,
                                    std::uint32_t* list) {
    const std::uint32_t item = thread_number();
    if (item >= count) return;
    codes[item] = cells.code(items.bounds(item), false);
    list[item] = item;
}

/// For a list of items; `within`: see CurveCells::code().
static __global__ void codes_of_list_kernel(LeafItems items, std::uint32_t count, CurveCells cells, bool within,
                                            const std::uint32_t* list, std::uint64_t* codes) {
    const std::uint32_t place = thread_number();
    if (place < count) codes[place] = cells.code(items.bounds(list[place]), within);
}

/// Numbers of items that are smaller than a cell, and smaller than a coarse one.
struct TinyCounts {
    std::uint32_t for_cells, for_coarse_cells;
};

/// Of every `step`-th item.
static __global__ void count_tiny_kernel(LeafItems items, std::uint32_t count, std::uint32_t step, CurveCells cells,
                                         TinyCounts* tiny) {
    const std::uint32_t sample = thread_number();
    double size = curve_cells;  // in cells
    if (sample <= (count - 1) / step) {
        const Aabb box = items.bounds(sample * step);
        const Vec3d extent = widen(box.upper) - widen(box.lower);
        size = greater(greater(extent.x, extent.y), extent.z) * cells.per_metre;
    }
    const auto add = [&](double most, std::uint32_t* to) {
        const std::uint32_t found = __popc(__ballot_sync(~0U, size < most));
        if (threadIdx.x % 32 == 0 && found != 0) atomicAdd(to, found);
    };
    add(1, &tiny->for_cells);
    add(1U << fine_bits, &tiny->for_coarse_cells);
}

/// `order`: the items along the curve.
static __global__ void leaves_kernel(LeafItems items, const std::uint32_t* order, Padding padding, BuildTree tree,
                                     std::uint32_t* list) {
    const std::uint32_t place = thread_number();
    if (place >= tree.leaves) return;
    const std::uint32_t item = order[place];
    tree.nodes[place] = {pad(items.bounds(item), padding), items.primitive(item), item};
    list[place] = place;
}

/// The progress of merging. On the GPU, so that the host need not wait for it after each round.
struct MergeState {
    std::uint32_t clusters;  ///< on the list
    std::uint32_t nodes;     ///< made so far, with the leaves
};

/// For each place on the list, the place of the cluster to merge with, at most `radius` places away; its own if no more
/// than `enough` clusters are left.
template <int radius>
__global__ void nearest_kernel(const BuildNode* nodes, const std::uint32_t* list, const MergeState* state,
                               std::uint32_t enough, std::uint32_t* nearest) {
    const std::uint32_t count = state->clusters;
    if (blockIdx.x * build_block >= count) return;
    if (count <= enough) {
        if (thread_number() < count) nearest[thread_number()] = thread_number();
        return;
    }
    constexpr int length = build_block + 2 * radius;
    __shared__ float sides[6][length];  // not Aabb, whose length shares banks
    const int start = static_cast<int>(blockIdx.x * build_block) - radius;
    for (int i = static_cast<int>(threadIdx.x); i < length; i += build_block) {
        const int place = start + i;
        const bool is_there = place >= 0 && static_cast<std::uint32_t>(place) < count;
        // an infinite area is never the smallest
        const float far = __int_as_float(0x7F800000);
        const Aabb box = is_there ? nodes[list[place]].box : Aabb{{0, 0, 0}, {far, far, far}};
        const float of_box[] = {box.lower.x, box.lower.y, box.lower.z, box.upper.x, box.upper.y, box.upper.z};
        for (int side = 0; side < 6; ++side) sides[side][i] = of_box[side];
    }
    __syncthreads();
    const std::uint32_t place = thread_number();
    if (place >= count) return;
    const int own_at = static_cast<int>(threadIdx.x) + radius;
    const auto box_at = [&](int i) {
        return Aabb{{sides[0][i], sides[1][i], sides[2][i]}, {sides[3][i], sides[4][i], sides[5][i]}};
    };
    const Aabb own = box_at(own_at);
    float least = __int_as_float(0x7F800000);
    std::uint32_t least_difference = 0xFFFFFFFFU;
    for (int offset = -radius; offset <= radius; ++offset) {
        if (offset == 0) continue;
        const float area = half_area(merge(own, box_at(own_at + offset)));
        const std::uint32_t difference = place ^ (place + static_cast<std::uint32_t>(offset));
        if (area < least || (area == least && difference < least_difference)) {
            least = area;
            least_difference = difference;
        }
    }
    nearest[place] = place ^ least_difference;
}

static __global__ void gather_boxes_kernel(const BuildNode* nodes, const std::uint32_t* list, std::uint32_t count,
                                           Aabb* boxes) {
    const std::uint32_t place = thread_number();
    if (place < count) boxes[place] = nodes[list[place]].box;
}

static __global__ void set_parents_kernel(const std::uint32_t* list, const std::uint32_t* parents, std::uint32_t count,
                                          BuildTree tree) {
    const std::uint32_t place = thread_number();
    if (place < count) tree.parents[list[place]] = parents[place];
}

/// Neighbours, whatever their areas.
static __global__ void neighbours_kernel(const MergeState* state, std::uint32_t enough, std::uint32_t* nearest) {
    const std::uint32_t place = thread_number(), count = state->clusters;
    if (place >= count) return;
    const std::uint32_t other = place ^ 1U;
    nearest[place] = other < count && count > enough ? other : place;
}

__device__ inline bool is_mutual(const std::uint32_t* nearest, std::uint32_t place) {
    const std::uint32_t other = nearest[place];
    return other != place && nearest[other] == place;
}

/// High: whether a place becomes a node with another one; low: whether it stays on the list. 0 beyond the list.
struct MergeCounts {
    const std::uint32_t* nearest;
    const MergeState* state;

    __device__ Counts operator()(std::uint32_t place) const {
        if (place >= state->clusters) return 0;
        const bool mutual = is_mutual(nearest, place);
        const bool is_first = place < nearest[place];
        return counts(mutual && is_first ? 1 : 0, mutual && !is_first ? 0 : 1);
    }
};

/// `sums`: those of MergeCounts; `most`: at least the number of clusters. Sets the state after this round.
static __global__ void merge_kernel(BuildTree tree, const std::uint32_t* nearest, const Counts* sums,
                                    std::uint32_t most, const MergeState* state, MergeState* next_state,
                                    const std::uint32_t* list, std::uint32_t* next_list) {
    const std::uint32_t place = thread_number(), count = state->clusters, first_node = state->nodes;
    if (place == 0) *next_state = {low_of(sums[most]), first_node + high_of(sums[most])};
    if (place >= count) return;
    const bool mutual = is_mutual(nearest, place);
    const std::uint32_t other = nearest[place];
    if (mutual && other < place) return;
    std::uint32_t node = list[place];
    if (mutual) {
        const std::uint32_t first = node, second = list[other];
        node = first_node + high_of(sums[place]);
        tree.nodes[node] = {merge(tree.nodes[first].box, tree.nodes[second].box), first, second};
        tree.parents[first] = tree.parents[second] = node;
    }
    next_list[low_of(sums[place])] = node;
}

}  // namespace tandem::cuda
