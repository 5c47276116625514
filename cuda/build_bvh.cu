#include "cuda/build_bvh.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>

#include "cuda/cluster_kernels.h"
#include "cuda/cut_kernels.h"
#include "cuda/launch.h"
#include "cuda/reinsertion_kernels.h"
#include "cuda/wide_node_kernels.h"
#include "tandem/compile/binary_tree.h"
#include "tandem/compile/build_bvh.h"

namespace tandem::cuda {

namespace {

/// Lays out arrays one after another.
class Arena {
  public:
    template <class T>
    std::size_t add(std::size_t count) {
        const std::size_t at = bytes_;
        bytes_ += (count * sizeof(T) + 255) / 256 * 256;
        return at;
    }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

  private:
    std::size_t bytes_ = 0;
};

class Builder {
  public:
    Builder(const SceneView& scene, BuildMemory& memory, cudaStream_t stream, const BuildEffort& effort)
        : scene_(scene), count_(primitive_count(scene)), effort_(effort), memory_(memory), stream_(stream) {
        reserve();
    }

    BuiltBvh run() {
        find_bounds();
        merge_clusters(sort_leaves());
        for (int i = 0; i < effort_.passes; ++i) improve();
        plan_nodes();
        write_tree();
        built_.root_area = whole_;
        built_.cost = widen(fetch(tree_.of + root_).cost[0]);
        return built_;
    }

  private:
    /// MergeCounts by place; computed where the scan reads them, which saves memory traffic and a launch.
    [[nodiscard]] auto merge_counts(const MergeState* state) const {
        return thrust::make_transform_iterator(thrust::make_counting_iterator(std::uint32_t{0}),
                                               MergeCounts{nearest_, state});
    }

    [[nodiscard]] LeafItems items() const { return {scene_, reinterpret_cast<const Piece*>(pieces_.data())}; }

    /// Reserves one block of scratch memory for all arrays. There are `count_` + 1 sums, and the plan has at most one
    /// node per leaf.
    void reserve() {
        Arena arena;
        const std::size_t n = count_;
        const auto bounds = arena.add<OrderedBounds>(1), states = arena.add<MergeState>(2);
        const auto nodes = arena.add<BuildNode>(2 * n), forests = arena.add<Forests>(2 * n);
        const auto parents = arena.add<std::uint32_t>(2 * n);
        const auto codes = arena.add<std::uint64_t>(std::max(2 * n, 3 * std::size_t{effort_.top_clusters}));
        const auto moves = arena.add<Move>(effort_.passes > 0 ? 2 * n : 0);
        const auto lists = arena.add<std::uint32_t>(2 * n), nearest = arena.add<std::uint32_t>(n);
        const auto sums = arena.add<Counts>(2 * (n + 1)), plans = arena.add<WidePlan>(n);
        const auto planned = arena.add<PlannedLevels>(1);
        std::size_t sort_bytes = 0, scan_bytes = 0, merge_scan_bytes = 0;
        cub::DoubleBuffer<std::uint64_t> no_codes;
        cub::DoubleBuffer<std::uint32_t> no_ids;
        check(cub::DeviceRadixSort::SortPairs(nullptr, sort_bytes, no_codes, no_ids, static_cast<int>(count_), 0,
                                              code_bits, stream_),
              doing);
        check(cub::DeviceScan::ExclusiveSum(nullptr, scan_bytes, sums_, sums_, static_cast<int>(count_ + 1), stream_),
              doing);
        check(cub::DeviceScan::ExclusiveSum(nullptr, merge_scan_bytes, merge_counts(nullptr), sums_,
                                            static_cast<int>(count_ + 1), stream_),
              doing);
        cub_bytes_ = std::max({sort_bytes, scan_bytes, merge_scan_bytes});
        const auto cub_memory = arena.add<std::byte>(cub_bytes_);
        memory_.scratch.reserve(arena.bytes());
        memory_.word.reserve(std::max(sizeof(OrderedBounds), sizeof(PlannedLevels)));
        const auto at = [&]<class T>(std::size_t offset, T*& pointer) {
            pointer = reinterpret_cast<T*>(memory_.scratch.data() + offset);
        };
        at(bounds, device_bounds_);
        at(states, states_);
        at(nodes, tree_.nodes);
        at(forests, tree_.of);
        at(parents, tree_.parents);
        at(codes, codes_);
        at(moves, moves_);
        at(lists, lists_);
        at(nearest, nearest_);
        at(sums, sums_);
        at(plans, plans_);
        at(planned, planned_);
        at(cub_memory, cub_memory_);
        tree_.leaves = count_;
    }

    template <class... Parameters, class... Arguments>
    void run_kernel(void (*kernel)(Parameters...), std::uint32_t threads, Arguments&&... arguments) {
        launch(doing, kernel, (threads + build_block - 1) / build_block, build_block, stream_, arguments...);
    }

    /// A value from GPU memory.
    template <class T>
    T fetch(const T* from) {
        T value;
        fetch_bytes(&value, from, sizeof(T), memory_.word, doing, stream_);
        return value;
    }

    void find_bounds() {
        bounds_ = scene_bounds(scene_, device_bounds_, memory_.word, doing, stream_);
        built_.view.frame = make_structure_frame(bounds_, BoxErrors::of_distance);
        whole_ = wide_half_area(pad(bounds_, built_.view.frame.padding));
    }

    /// The list of clusters: the leaves in the order of the curve.
    std::uint32_t* sort_leaves() {
        const Vec3d extent = widen(bounds_.upper) - widen(bounds_.lower);
        const double largest = greater(greater(extent.x, extent.y), extent.z);
        const CurveCells cells = {bounds_.lower, largest > 0 ? curve_cells / largest : 0};  // 0 for a single point
        CurveOrder order = sort_along(cells);
        if (effort_.cuts && may_have_pieces(scene_) && cut(order, cells)) order = sort_along(cells);
        run_kernel(leaves_kernel, count_, items(), order.list, built_.view.frame.padding, tree_, order.spare);
        return order.spare;
    }

    /// The items of the leaves in the order of the curve.
    struct CurveOrder {
        const std::uint32_t* list;
        std::uint32_t* spare;  ///< memory for as many numbers
        const std::uint64_t* codes;
        int first_bit;  ///< of those of a code that they are sorted by
    };
    CurveOrder sort_along(const CurveCells& cells) {
        const auto [in_detail, in_fine_cells] = needed_order(cells);
        run_kernel(codes_kernel, count_, items(), count_, cells, codes_, lists_);
        cub::DoubleBuffer<std::uint64_t> codes(codes_, codes_ + count_);
        cub::DoubleBuffer<std::uint32_t> ids(lists_, lists_ + count_);
        const int first_bit = in_fine_cells ? 0 : 3 * fine_bits;
        const auto sort = [&] {
            check(cub::DeviceRadixSort::SortPairs(cub_memory_, cub_bytes_, codes, ids, static_cast<int>(count_),
                                                  first_bit, code_bits, stream_),
                  doing);
        };
        if (in_detail) {  // by the places within cells, then, in a sort that keeps their order, by the cells
            for (const bool within : {true, false}) {
                run_kernel(codes_of_list_kernel, count_, items(), count_, cells, within, ids.Current(),
                           codes.Current());
                if (within) sort();
            }
        }
        sort();
        return {ids.Current(), ids.Alternate(), codes.Current(), first_bit};
    }

    /// Cuts long, thin primitives: from now on the leaves are pieces. Whether there are any.
    bool cut(const CurveOrder& order, const CurveCells& cells) {
        const SortedPrimitives sorted = {order.codes, order.list, count_, order.first_bit};
        run_kernel(count_pieces_kernel, count_ + 1, scene_, sorted, cells.per_metre, sums_);
        scan(sums_, count_);
        const std::uint32_t pieces = low_of(fetch(summed() + count_));
        if (pieces == count_ || pieces > most_leaves()) return false;
        pieces_.reserve(pieces * sizeof(Piece));
        run_kernel(pieces_kernel, count_, order.list, count_, summed(), reinterpret_cast<Piece*>(pieces_.data()));
        count_ = pieces;
        reserve();
        return true;
    }

    struct NeededOrder {
        bool in_detail;      ///< within cells of the curve
        bool in_fine_cells;  ///< within its coarse cells
    };
    /// How many leaves a tree with pieces may have; with more, it has none.
    [[nodiscard]] std::uint32_t most_leaves() const {
        if (effort_.most_leaves != 0) return effort_.most_leaves;
        std::size_t free = 0, all = 0;
        check(cudaMemGetInfo(&free, &all), doing);
        constexpr std::size_t bytes = 2 * build_bytes_per_primitive;  // a tree takes half as much as its build
        return static_cast<std::uint32_t>(std::min<std::size_t>(free / bytes, max_bvh_primitives));
    }

    /// By whether, of up to 16,384 items at equal steps through the list, one in 64 is smaller than a cell. Then
    /// many may share a cell, for example where a scene is far larger than what most of it consists of.
    [[nodiscard]] NeededOrder needed_order(const CurveCells& cells) {
        constexpr std::uint32_t most = 16'384;
        const std::uint32_t step = (count_ - 1) / most + 1, samples = (count_ - 1) / step + 1;
        check(cudaMemsetAsync(sums_, 0, sizeof(TinyCounts), stream_), doing);
        auto* const counts = reinterpret_cast<TinyCounts*>(sums_);
        run_kernel(count_tiny_kernel, samples, items(), count_, step, cells, counts);
        const TinyCounts tiny = fetch(counts);
        return {64 * tiny.for_cells >= samples, 64 * tiny.for_coarse_cells >= samples};
    }

    /// Exclusive sums of `count` + 1 elements, of which the last is the sum of all: summed().
    template <class Elements>
    void scan(Elements elements, std::uint32_t count) {
        check(cub::DeviceScan::ExclusiveSum(cub_memory_, cub_bytes_, elements, sums_ + count_ + 1,
                                            static_cast<int>(count + 1), stream_),
              doing);
    }
    [[nodiscard]] const Counts* summed() const { return sums_ + count_ + 1; }

    /// `list`: one of the two of lists_.
    void merge_clusters(std::uint32_t* list) {
        MergeState state = {count_, count_};
        check(cudaMemcpyAsync(states_, &state, sizeof(state), cudaMemcpyHostToDevice, stream_), doing);
        std::uint32_t* next = list == lists_ ? lists_ + count_ : lists_;
        MergeState *now = states_, *then = states_ + 1;
        for (int round = 0; state.clusters > effort_.top_clusters; ++round) {
            const std::uint32_t most = state.clusters, enough = effort_.top_clusters;
            if (round + rounds_of_halving(most) < max_bvh_depth) {
                run_kernel(effort_.far ? nearest_kernel<12> : nearest_kernel<8>, most, tree_.nodes, list, now, enough,
                           nearest_);
            } else {
                run_kernel(neighbours_kernel, most, now, enough, nearest_);
            }
            scan(merge_counts(now), most);
            run_kernel(merge_kernel, most, tree_, nearest_, summed(), most, now, then, list, next);
            std::swap(list, next);
            std::swap(now, then);
            // in short rounds, the host fetches the number of clusters only once in rounds_per_look rounds
            if (most > long_round || round % rounds_per_look == 0) state = fetch(now);
        }
        std::uint32_t nodes = state.nodes;
        if (state.clusters > 1) nodes = build_top(list, state.clusters, nodes, next);
        root_ = nodes - 1;
        check(cudaMemsetAsync(tree_.parents + root_, 0xFF, sizeof(std::uint32_t), stream_), doing);
    }

    /// Joins the clusters on the list from the top down, on the host. `spare`: memory for as many numbers.
    std::uint32_t build_top(const std::uint32_t* list, std::uint32_t clusters, std::uint32_t nodes,
                            std::uint32_t* spare) {
        auto* boxes_there = reinterpret_cast<Aabb*>(codes_);  // of 24 bytes, for which reserve() makes room
        run_kernel(gather_boxes_kernel, clusters, tree_.nodes, list, clusters, boxes_there);
        const std::vector<Aabb> boxes = download(boxes_there, clusters);
        const std::vector<std::uint32_t> numbers = download(list, clusters);
        const BinaryTree top = build_binary_tree(boxes);
        // Inner nodes from the bottom up, so that the root is the last
        std::vector<std::uint32_t> number_of(top.nodes.size());
        std::vector<BuildNode> inner;
        for (std::size_t i = top.nodes.size(); i-- > 0;) {
            const BinaryNode& node = top.nodes[i];
            if (node.is_leaf()) {
                number_of[i] = numbers[top.order[node.first_primitive]];
                continue;
            }
            number_of[i] = nodes + static_cast<std::uint32_t>(inner.size());
            inner.push_back({node.box, number_of[i + 1], number_of[node.second]});
        }
        std::vector<std::uint32_t> parents(inner.size(), no_parent), parents_of_clusters(clusters);
        for (std::size_t i = 0; i < top.nodes.size(); ++i) {
            if (top.nodes[i].is_leaf()) continue;
            for (const std::size_t child : {i + 1, std::size_t{top.nodes[i].second}}) {
                const BinaryNode& node = top.nodes[child];
                (node.is_leaf() ? parents_of_clusters[top.order[node.first_primitive]]
                                : parents[number_of[child] - nodes]) = number_of[i];
            }
        }
        upload(inner, tree_.nodes + nodes);
        upload(parents, tree_.parents + nodes);
        upload(parents_of_clusters, spare);
        run_kernel(set_parents_kernel, clusters, list, spare, clusters, tree_);
        return nodes + static_cast<std::uint32_t>(inner.size());
    }

    template <class T>
    std::vector<T> download(const T* from, std::size_t count) {
        std::vector<T> values(count);
        check(cudaMemcpyAsync(values.data(), from, count * sizeof(T), cudaMemcpyDeviceToHost, stream_), doing);
        check(cudaStreamSynchronize(stream_), doing);
        return values;
    }
    template <class T>
    void upload(const std::vector<T>& values, T* to) {
        check(cudaMemcpyAsync(to, values.data(), values.size() * sizeof(T), cudaMemcpyHostToDevice, stream_), doing);
        check(cudaStreamSynchronize(stream_), doing);
    }

    /// Moves subtrees to better places: at once all moves that do not conflict.
    void improve() {
        const std::uint32_t nodes = root_ + 1;
        auto* claims = reinterpret_cast<unsigned long long*>(codes_);
        check(cudaMemsetAsync(claims, 0, nodes * sizeof(*claims), stream_), doing);
        run_kernel(search_kernel, nodes, tree_, nodes, moves_);
        run_kernel(claim_kernel, nodes, tree_, nodes, moves_, claims);
        run_kernel(drop_kernel, nodes, tree_, nodes, moves_, claims);
        run_kernel(move_kernel, nodes, tree_, nodes, moves_);
        climb(climb_kernel<false>);
    }

    void climb(void (*kernel)(BuildTree, double, std::uint32_t*)) {
        check(cudaMemsetAsync(lists_, 0, (root_ + 1) * sizeof(*lists_), stream_), doing);
        run_kernel(kernel, count_, tree_, whole_, lists_);
    }

    /// How often that many clusters can be halved until one is left.
    static int rounds_of_halving(std::uint32_t clusters) {
        int rounds = 0;
        while (clusters > 1) {
            clusters = clusters / 2 + clusters % 2;
            ++rounds;
        }
        return rounds;
    }

    void plan_nodes() {
        climb(climb_kernel<true>);
        WidePlan root{};
        root.child[0] = root_;
        check(cudaMemcpyAsync(plans_, &root, sizeof(root), cudaMemcpyHostToDevice, stream_), doing);
        PlanLevel level = {0, 1, 0};
        const auto finish = [&](const PlanLevel& next) {
            built_.level_starts.push_back(level.begin);
            ++built_.levels;
            level = next;
        };
        while (level.size() != 0) {
            if (level.size() <= build_block) {
                launch(doing, small_levels_kernel, 1, build_block, stream_, tree_, plans_, level, planned_);
                const PlannedLevels planned = fetch(planned_);
                for (std::uint32_t i = 0; i < planned.count; ++i) finish(planned.next[i]);
            } else {
                run_kernel(find_children_kernel, level.size() + 1, tree_, plans_, level, sums_);
                scan(sums_, level.size());
                const Counts children = fetch(summed() + level.size());
                run_kernel(place_children_kernel, level.size(), tree_, plans_, level, summed());
                finish(level.next(children));
            }
        }
        built_.node_count = level.begin;
        built_.level_starts.push_back(level.begin);
    }

    void write_tree() {
        Arena arena;
        const std::size_t entries = std::size_t{count_} + spare_entries;
        const bool by_entry = placed_by_entry(scene_);
        const std::size_t placements =
            by_entry ? entries : std::size_t{scene_.ellipsoid_count} + scene_.parallelepiped_count;
        const bool only_triangles = scene_.triangle_count == primitive_count(scene_);
        const auto nodes = arena.add<BvhNode>(built_.node_count);
        const auto spheres = arena.add<Sphere>(entries);
        const auto ids = arena.add<std::uint32_t>(entries);
        const auto triangles = arena.add<EntryTriangle>(only_triangles ? entries : 0);
        const auto rough = arena.add<RoughPlacement>(placements);
        const bool has_pieces = pieces_.data() != nullptr;
        const auto pieces = arena.add<Piece>(has_pieces ? entries : 0);
        memory_.tree.reserve(arena.bytes());
        std::byte* base = memory_.tree.data();
        const TreeArrays to = {reinterpret_cast<BvhNode*>(base + nodes),
                               reinterpret_cast<Sphere*>(base + spheres),
                               reinterpret_cast<std::uint32_t*>(base + ids),
                               only_triangles ? reinterpret_cast<EntryTriangle*>(base + triangles) : nullptr,
                               reinterpret_cast<RoughPlacement*>(base + rough),
                               by_entry,
                               has_pieces ? reinterpret_cast<Piece*>(base + pieces) : nullptr};
        run_kernel(nodes_kernel, built_.node_count, items(), tree_, plans_, built_.node_count, to);
        write_rest(scene_, to, count_, doing, stream_);
        built_.arrays = to;
        built_.entry_count = count_;
        built_.view.nodes = to.nodes;
        built_.view.entry_spheres = to.spheres;
        built_.view.entry_ids = to.ids;
        built_.view.entry_triangles = to.triangles;
        built_.view.placements = to.placements;
        built_.view.placed_by_entry = by_entry ? 1 : 0;
    }

    static constexpr const char* doing = "building a BVH";
    static constexpr int code_bits = 63;
    static constexpr std::uint32_t long_round = 1U << 19;  ///< clusters
    static constexpr int rounds_per_look = 4;

    SceneView scene_;
    std::uint32_t count_;  ///< leaves
    BuildEffort effort_;
    BuildMemory& memory_;
    cudaStream_t stream_;
    BuiltBvh built_{};
    Buffer<DeviceMemory> pieces_;  ///< empty: the leaves are the primitives
    Aabb bounds_;
    double whole_ = 0;
    std::uint32_t root_ = 0;
    OrderedBounds* device_bounds_ = nullptr;
    MergeState* states_ = nullptr;  ///< before a round, and after it
    BuildTree tree_{};
    std::uint64_t* codes_ = nullptr;  ///< two arrays
    std::uint32_t* lists_ = nullptr;  ///< two arrays
    std::uint32_t* nearest_ = nullptr;
    Counts* sums_ = nullptr;  ///< counts, then their sums
    WidePlan* plans_ = nullptr;
    PlannedLevels* planned_ = nullptr;
    Move* moves_ = nullptr;
    std::byte* cub_memory_ = nullptr;
    std::size_t cub_bytes_ = 0;
};

}  // namespace

BuiltBvh build_bvh(const SceneView& scene, BuildMemory& memory, cudaStream_t stream, const BuildEffort& effort) {
    check_bvh_size(primitive_count(scene));
    const BuiltBvh built = Builder(scene, memory, stream, effort).run();
    // the top and the moves may make a tree too deep for the traversal
    return built.levels <= max_bvh_depth ? built : Builder(scene, memory, stream, {1, 0, false}).run();
}

}  // namespace tandem::cuda
