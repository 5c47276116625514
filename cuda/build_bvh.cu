#include "cuda/build_bvh.h"

#include <cstring>
#include <utility>

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>

#include "cuda/launch.h"
#include "tandem/compile/build_bvh.h"
#include "tandem/kernel/traversal/collapse.h"
#include "tandem/kernel/traversal/hit_interval.h"
#include "tandem/kernel/traversal/make_node.h"

namespace tandem::cuda {

namespace {

constexpr unsigned int block_threads = 256;
constexpr int merge_radius = 12;  ///< places on the curve, to either side

/// A node of the binary tree. Leaves come first, in the order of the curve; children come before their parents.
struct BuildNode {
    Aabb box;  ///< padded
    std::uint32_t first, second;  ///< children; of a leaf, `first` is the id of the primitive
};
static_assert(sizeof(BuildNode) == 32);

/// A node of four children before its children have places.
struct WidePlan {
    std::uint32_t root;  ///< the binary node that it replaces
    std::int32_t first_inner, first_entry;
};

/// Two counts that are summed together.
using Counts = std::uint64_t;
__host__ __device__ Counts counts(std::uint32_t high, std::uint32_t low) { return Counts{high} << 32 | low; }
__host__ __device__ std::uint32_t high_of(Counts counts) { return static_cast<std::uint32_t>(counts >> 32); }
__host__ __device__ std::uint32_t low_of(Counts counts) { return static_cast<std::uint32_t>(counts); }

struct BuildTree {
    BuildNode* nodes;
    Forests* of;
    std::uint32_t leaves;

    __device__ bool is_leaf(std::uint32_t node) const { return node < leaves; }
    __device__ std::uint32_t first(std::uint32_t node) const { return nodes[node].first; }
    __device__ std::uint32_t second(std::uint32_t node) const { return nodes[node].second; }
    __device__ const Forests& forests(std::uint32_t node) const { return of[node]; }
};

__device__ std::uint32_t thread_number() { return blockIdx.x * blockDim.x + threadIdx.x; }

// Floats as integers of the same order, for atomic minima and maxima.
__host__ __device__ std::uint32_t ordered_bits(float a) {
    const std::uint32_t bits = bits_of(a);
    return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
}
__host__ __device__ float from_ordered_bits(std::uint32_t bits) {
    return float_of((bits & 0x80000000U) != 0 ? bits & 0x7FFFFFFFU : ~bits);
}

/// The bounds of all primitives, as ordered bits.
struct OrderedBounds {
    std::uint32_t lower[3], upper[3];
};

__global__ void bounds_kernel(SceneView scene, std::uint32_t count, OrderedBounds* bounds) {
    Aabb box;
    for (std::uint32_t id = thread_number(); id < count; id += gridDim.x * blockDim.x) {
        box = merge(box, primitive_bounds(scene, id));
    }
    const float lower[] = {box.lower.x, box.lower.y, box.lower.z}, upper[] = {box.upper.x, box.upper.y, box.upper.z};
    for (int axis = 0; axis < 3; ++axis) {
        const std::uint32_t least = __reduce_min_sync(~0U, ordered_bits(lower[axis]));
        const std::uint32_t most = __reduce_max_sync(~0U, ordered_bits(upper[axis]));
        if (threadIdx.x % 32 == 0) {
            atomicMin(&bounds->lower[axis], least);
            atomicMax(&bounds->upper[axis], most);
        }
    }
}

/// The low 21 bits of x, two zeros between each and the next.
__device__ std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x001F00000000FFFFULL;
    x = (x | x << 16) & 0x001F0000FF0000FFULL;
    x = (x | x << 8) & 0x100F00F00F00F00FULL;
    x = (x | x << 4) & 0x10C30C30C30C30C3ULL;
    x = (x | x << 2) & 0x1249249249249249ULL;
    return x;
}

/// Cells are cubes, so that they fit boxes of any shape. `cells`: per metre.
__global__ void codes_kernel(SceneView scene, std::uint32_t count, Vec3f lower, double cells, std::uint64_t* codes,
                             std::uint32_t* ids) {
    const std::uint32_t id = thread_number();
    if (id >= count) return;
    const Aabb box = primitive_bounds(scene, id);
    const auto cell = [&](float a, float b, float from) {
        const double place = ((widen(a) + widen(b)) * 0.5 - widen(from)) * cells;
        return static_cast<std::uint64_t>(lesser(greater(place, 0.0), 2097151.0));
    };
    codes[id] = spread(cell(box.lower.x, box.upper.x, lower.x)) << 2 |
                spread(cell(box.lower.y, box.upper.y, lower.y)) << 1 |
                spread(cell(box.lower.z, box.upper.z, lower.z));
    ids[id] = id;
}

__global__ void leaves_kernel(SceneView scene, const std::uint32_t* ids, float margin, double whole, BuildTree tree,
                              std::uint32_t* list) {
    const std::uint32_t place = thread_number();
    if (place >= tree.leaves) return;
    const std::uint32_t id = ids[place];
    const Aabb box = pad(primitive_bounds(scene, id), margin);
    tree.nodes[place] = {box, id, 0};
    tree.of[place] = forests_of_leaf(relative_area(box, whole));
    list[place] = place;
}

/// For each place on the list, the place of the cluster to merge with.
__global__ void nearest_kernel(const BuildNode* nodes, const std::uint32_t* list, std::uint32_t count,
                               std::uint32_t* nearest) {
    __shared__ Aabb boxes[block_threads + 2 * merge_radius];
    const std::int64_t start = std::int64_t{blockIdx.x} * block_threads - merge_radius;
    for (unsigned int i = threadIdx.x; i < block_threads + 2 * merge_radius; i += block_threads) {
        const std::int64_t place = start + i;
        if (place >= 0 && place < count) boxes[i] = nodes[list[place]].box;
    }
    __syncthreads();
    const std::uint32_t place = thread_number();
    if (place >= count) return;
    const Aabb own = boxes[threadIdx.x + merge_radius];
    std::uint64_t least = ~std::uint64_t{0};
    std::uint32_t best = place;
    for (int offset = -merge_radius; offset <= merge_radius; ++offset) {
        const std::int64_t other = std::int64_t{place} + offset;
        if (offset == 0 || other < 0 || other >= count) continue;
        const auto at = static_cast<std::uint32_t>(other);
        const float area = half_area(merge(own, boxes[static_cast<int>(threadIdx.x) + merge_radius + offset]));
        const std::uint64_t key = std::uint64_t{bits_of(area)} << 32 | (place ^ at);
        if (key < least) {
            least = key;
            best = at;
        }
    }
    nearest[place] = best;
}

/// Neighbours, whatever their areas.
__global__ void neighbours_kernel(std::uint32_t count, std::uint32_t* nearest) {
    const std::uint32_t place = thread_number();
    if (place >= count) return;
    const std::uint32_t other = place ^ 1U;
    nearest[place] = other < count ? other : place;
}

__device__ bool is_mutual(const std::uint32_t* nearest, std::uint32_t place) {
    const std::uint32_t other = nearest[place];
    return other != place && nearest[other] == place;
}

/// High: places that become a node with another one; low: places that stay on the list. One more element for the sum.
__global__ void merge_counts_kernel(const std::uint32_t* nearest, std::uint32_t count, Counts* sums) {
    const std::uint32_t place = thread_number();
    if (place > count) return;
    const bool mutual = place < count && is_mutual(nearest, place);
    const bool is_first = place < count && place < nearest[place];
    sums[place] = place == count ? 0 : counts(mutual && is_first ? 1 : 0, mutual && !is_first ? 0 : 1);
}

__global__ void merge_kernel(BuildTree tree, double whole, const std::uint32_t* nearest, const Counts* sums,
                             std::uint32_t count, std::uint32_t first_node, const std::uint32_t* list,
                             std::uint32_t* next_list) {
    const std::uint32_t place = thread_number();
    if (place >= count) return;
    const bool mutual = is_mutual(nearest, place);
    const std::uint32_t other = nearest[place];
    if (mutual && other < place) return;
    std::uint32_t node = list[place];
    if (mutual) {
        const std::uint32_t first = node, second = list[other];
        node = first_node + high_of(sums[place]);
        const Aabb box = merge(tree.nodes[first].box, tree.nodes[second].box);
        tree.nodes[node] = {box, first, second};
        tree.of[node] = forests_of_node(relative_area(box, whole), tree.of[first], tree.of[second]);
    }
    next_list[low_of(sums[place])] = node;
}

/// High: inner children; low: leaves. One more element for the sum.
__global__ void child_counts_kernel(BuildTree tree, const WidePlan* level, std::uint32_t count, Counts* sums) {
    const std::uint32_t i = thread_number();
    if (i > count) return;
    std::uint32_t inner = 0, leaves = 0;
    if (i < count) {
        const WideChildren children = wide_children(tree, level[i].root);
        for (int k = 0; k < children.count; ++k) ++(tree.is_leaf(children.node[k]) ? leaves : inner);
    }
    sums[i] = counts(inner, leaves);
}

/// Gives the children of a level their places. `end`: of the level, in all nodes; `entries`: of the levels before.
__global__ void place_children_kernel(BuildTree tree, WidePlan* nodes, std::uint32_t begin, std::uint32_t end,
                                      std::uint32_t entries, const Counts* sums) {
    const std::uint32_t i = thread_number();
    if (i >= end - begin) return;
    WidePlan& plan = nodes[begin + i];
    std::uint32_t inner = end + high_of(sums[i]);
    plan.first_inner = static_cast<std::int32_t>(inner);
    plan.first_entry = static_cast<std::int32_t>(entries + low_of(sums[i]));
    const WideChildren children = wide_children(tree, plan.root);
    for (int k = 0; k < children.count; ++k) {
        if (!tree.is_leaf(children.node[k])) nodes[inner++].root = children.node[k];
    }
}

/// The parts of a tree in memory.
struct TreeArrays {
    BvhNode* nodes;
    Sphere* spheres;
    std::uint32_t* ids;
    EntryTriangle* triangles;  ///< null unless all primitives are triangles
    RoughPlacement* placements;
};

__device__ void write_entry(const SceneView& scene, const TreeArrays& to, std::uint32_t entry, std::uint32_t id) {
    to.ids[entry] = id;
    if (to.triangles != nullptr) to.triangles[entry] = entry_triangle(scene.triangles[id], id);
    visit_primitive(scene, id, [&](const auto& primitive) { to.spheres[entry] = sphere_around(primitive); });
}

__global__ void nodes_kernel(SceneView scene, BuildTree tree, const WidePlan* plans, std::uint32_t count,
                             TreeArrays to) {
    const std::uint32_t i = thread_number();
    if (i >= count) return;
    const WidePlan plan = plans[i];
    const WideChildren children = wide_children(tree, plan.root);
    Aabb boxes[bvh_width];
    int inner = 0;
    for (int k = 0; k < children.count; ++k) {
        if (!tree.is_leaf(children.node[k])) boxes[inner++] = tree.nodes[children.node[k]].box;
    }
    int all = inner;
    for (int k = 0; k < children.count; ++k) {
        if (!tree.is_leaf(children.node[k])) continue;
        const BuildNode& leaf = tree.nodes[children.node[k]];
        write_entry(scene, to, static_cast<std::uint32_t>(plan.first_entry + all - inner), leaf.first);
        boxes[all++] = leaf.box;
    }
    to.nodes[i] = make_node(boxes, all, inner, plan.first_inner, plan.first_entry);
}

/// Entries that children which are not there may name: those of the last primitive once more.
__global__ void spare_entries_kernel(TreeArrays to, std::uint32_t count) {
    const std::uint32_t entry = count + threadIdx.x;
    to.ids[entry] = to.ids[count - 1];
    to.spheres[entry] = to.spheres[count - 1];
    if (to.triangles != nullptr) to.triangles[entry] = to.triangles[count - 1];
}

__global__ void placements_kernel(SceneView scene, RoughPlacement* placements) {
    const std::uint32_t i = thread_number();
    if (i < scene.ellipsoid_count) {
        placements[i] = rough_placement(scene.ellipsoids[i]);
    } else if (i < scene.ellipsoid_count + scene.parallelepiped_count) {
        placements[i] = rough_placement(scene.parallelepipeds[i - scene.ellipsoid_count]);
    }
}

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
    Builder(const SceneView& scene, Buffer<DeviceMemory>& tree, cudaStream_t stream)
        : scene_(scene), count_(primitive_count(scene)), result_(tree), stream_(stream) {
        reserve();
    }

    BuiltBvh run() {
        find_bounds();
        sort_leaves();
        merge_clusters();
        plan_nodes();
        write_tree();
        check(cudaStreamSynchronize(stream_), "building a BVH");
        return built_;
    }

  private:
    /// One scratch block for everything. `count_` + 1 sums, and in the plan at most a node for each primitive.
    void reserve() {
        Arena arena;
        const std::size_t n = count_;
        const auto bounds = arena.add<OrderedBounds>(1);
        const auto nodes = arena.add<BuildNode>(2 * n), forests = arena.add<Forests>(2 * n);
        const auto codes = arena.add<std::uint64_t>(2 * n);
        const auto lists = arena.add<std::uint32_t>(2 * n), nearest = arena.add<std::uint32_t>(n);
        const auto sums = arena.add<Counts>(2 * (n + 1)), plans = arena.add<WidePlan>(n);
        std::size_t sort_bytes = 0, scan_bytes = 0;
        cub::DoubleBuffer<std::uint64_t> no_codes;
        cub::DoubleBuffer<std::uint32_t> no_ids;
        check(cub::DeviceRadixSort::SortPairs(nullptr, sort_bytes, no_codes, no_ids, static_cast<int>(count_), 0,
                                              code_bits, stream_),
              "building a BVH");
        check(cub::DeviceScan::ExclusiveSum(nullptr, scan_bytes, static_cast<Counts*>(nullptr),
                                            static_cast<Counts*>(nullptr), static_cast<int>(count_ + 1), stream_),
              "building a BVH");
        cub_bytes_ = sort_bytes > scan_bytes ? sort_bytes : scan_bytes;
        const auto cub_memory = arena.add<std::byte>(cub_bytes_);
        scratch_.reserve(arena.bytes());
        word_.reserve(sizeof(OrderedBounds));
        const auto at = [&]<class T>(std::size_t offset, T*& pointer) {
            pointer = reinterpret_cast<T*>(scratch_.data() + offset);
        };
        at(bounds, device_bounds_);
        at(nodes, tree_.nodes);
        at(forests, tree_.of);
        at(codes, codes_);
        at(lists, lists_);
        at(nearest, nearest_);
        at(sums, sums_);
        at(plans, plans_);
        at(cub_memory, cub_memory_);
        tree_.leaves = count_;
    }

    template <class... Parameters, class... Arguments>
    void run_kernel(void (*kernel)(Parameters...), std::uint32_t threads, Arguments&&... arguments) {
        launch("building a BVH", kernel, (threads + block_threads - 1) / block_threads, block_threads, stream_,
               arguments...);
    }

    /// A value from GPU memory.
    template <class T>
    T fetch(const T* from) {
        check(cudaMemcpyAsync(word_.data(), from, sizeof(T), cudaMemcpyDeviceToHost, stream_), "building a BVH");
        check(cudaStreamSynchronize(stream_), "building a BVH");
        T value;
        std::memcpy(&value, word_.data(), sizeof(T));
        return value;
    }

    void find_bounds() {
        check(cudaMemsetAsync(device_bounds_->lower, 0xFF, sizeof(device_bounds_->lower), stream_), "building a BVH");
        check(cudaMemsetAsync(device_bounds_->upper, 0, sizeof(device_bounds_->upper), stream_), "building a BVH");
        const std::uint32_t threads = count_ < most_bound_threads ? count_ : most_bound_threads;
        run_kernel(bounds_kernel, threads, scene_, count_, device_bounds_);
        const auto ordered = fetch(device_bounds_);
        const auto vector = [](const std::uint32_t* bits) {
            return Vec3f{from_ordered_bits(bits[0]), from_ordered_bits(bits[1]), from_ordered_bits(bits[2])};
        };
        bounds_ = {vector(ordered.lower), vector(ordered.upper)};
        built_.view.frame = make_structure_frame(bounds_);
        whole_ = wide_half_area(pad(bounds_, built_.view.frame.margin));
    }

    void sort_leaves() {
        const Vec3d extent = widen(bounds_.upper) - widen(bounds_.lower);
        const double largest = greater(greater(extent.x, extent.y), extent.z);
        const double cells = largest > 0 ? 2097152.0 / largest : 0;  // 0 for an extent beyond 1e-302 as well
        run_kernel(codes_kernel, count_, scene_, count_, bounds_.lower, cells, codes_, lists_);
        cub::DoubleBuffer<std::uint64_t> codes(codes_, codes_ + count_);
        cub::DoubleBuffer<std::uint32_t> ids(lists_, lists_ + count_);
        check(cub::DeviceRadixSort::SortPairs(cub_memory_, cub_bytes_, codes, ids, static_cast<int>(count_), 0,
                                              code_bits, stream_),
              "building a BVH");
        run_kernel(leaves_kernel, count_, scene_, ids.Current(), built_.view.frame.margin, whole_, tree_, nearest_);
        check(cudaMemcpyAsync(lists_, nearest_, count_ * sizeof(std::uint32_t), cudaMemcpyDeviceToDevice, stream_),
              "building a BVH");
    }

    /// Exclusive sums of `count` + 1 elements; returns the last, which is the sum of all.
    Counts sum(std::uint32_t count) {
        Counts* to = sums_ + count_ + 1;
        check(cub::DeviceScan::ExclusiveSum(cub_memory_, cub_bytes_, sums_, to, static_cast<int>(count + 1), stream_),
              "building a BVH");
        return fetch(to + count);
    }
    [[nodiscard]] const Counts* summed() const { return sums_ + count_ + 1; }

    void merge_clusters() {
        std::uint32_t clusters = count_, nodes = count_;
        std::uint32_t *list = lists_, *next = lists_ + count_;
        for (int round = 0; clusters > 1; ++round) {
            if (round + rounds_of_halving(clusters) < max_bvh_depth) {
                run_kernel(nearest_kernel, clusters, tree_.nodes, list, clusters, nearest_);
            } else {
                run_kernel(neighbours_kernel, clusters, clusters, nearest_);
            }
            run_kernel(merge_counts_kernel, clusters + 1, nearest_, clusters, sums_);
            const Counts total = sum(clusters);
            run_kernel(merge_kernel, clusters, tree_, whole_, nearest_, summed(), clusters, nodes, list, next);
            nodes += high_of(total);
            clusters = low_of(total);
            std::swap(list, next);
        }
        root_ = nodes - 1;
    }

    /// How often that many clusters can halve until one is left.
    static int rounds_of_halving(std::uint32_t clusters) {
        int rounds = 0;
        while (clusters > 1) {
            clusters = clusters / 2 + clusters % 2;
            ++rounds;
        }
        return rounds;
    }

    void plan_nodes() {
        const WidePlan root = {root_, 0, 0};
        check(cudaMemcpyAsync(plans_, &root, sizeof(root), cudaMemcpyHostToDevice, stream_), "building a BVH");
        std::uint32_t begin = 0, end = 1, entries = 0;
        while (begin < end) {
            run_kernel(child_counts_kernel, end - begin + 1, tree_, plans_ + begin, end - begin, sums_);
            const Counts total = sum(end - begin);
            run_kernel(place_children_kernel, end - begin, tree_, plans_, begin, end, entries, summed());
            begin = end;
            end += high_of(total);
            entries += low_of(total);
            ++built_.levels;
        }
        built_.node_count = end;
    }

    void write_tree() {
        Arena arena;
        const std::size_t entries = std::size_t{count_} + spare_entries;
        const std::size_t placements = std::size_t{scene_.ellipsoid_count} + scene_.parallelepiped_count;
        const bool only_triangles = scene_.triangle_count == count_;
        const auto nodes = arena.add<BvhNode>(built_.node_count);
        const auto spheres = arena.add<Sphere>(entries);
        const auto ids = arena.add<std::uint32_t>(entries);
        const auto triangles = arena.add<EntryTriangle>(only_triangles ? entries : 0);
        const auto rough = arena.add<RoughPlacement>(placements);
        result_.reserve(arena.bytes());
        std::byte* base = result_.data();
        const TreeArrays to = {reinterpret_cast<BvhNode*>(base + nodes), reinterpret_cast<Sphere*>(base + spheres),
                               reinterpret_cast<std::uint32_t*>(base + ids),
                               only_triangles ? reinterpret_cast<EntryTriangle*>(base + triangles) : nullptr,
                               reinterpret_cast<RoughPlacement*>(base + rough)};
        run_kernel(nodes_kernel, built_.node_count, scene_, tree_, plans_, built_.node_count, to);
        launch("building a BVH", spare_entries_kernel, 1, spare_entries, stream_, to, count_);
        if (placements > 0) run_kernel(placements_kernel, static_cast<std::uint32_t>(placements), scene_, to.placements);
        built_.view.nodes = to.nodes;
        built_.view.entry_spheres = to.spheres;
        built_.view.entry_ids = to.ids;
        built_.view.entry_triangles = to.triangles;
        built_.view.placements = to.placements;
    }

    static constexpr int code_bits = 63;
    static constexpr std::uint32_t most_bound_threads = 1U << 18;

    SceneView scene_;
    std::uint32_t count_;
    Buffer<DeviceMemory>& result_;
    cudaStream_t stream_;
    Buffer<DeviceMemory> scratch_;
    Buffer<PinnedMemory> word_;
    BuiltBvh built_{};
    Aabb bounds_;
    double whole_ = 0;
    std::uint32_t root_ = 0;
    OrderedBounds* device_bounds_ = nullptr;
    BuildTree tree_{};
    std::uint64_t* codes_ = nullptr;     ///< two arrays
    std::uint32_t* lists_ = nullptr;     ///< two arrays
    std::uint32_t* nearest_ = nullptr;
    Counts* sums_ = nullptr;  ///< counts, then their sums
    WidePlan* plans_ = nullptr;
    std::byte* cub_memory_ = nullptr;
    std::size_t cub_bytes_ = 0;
};

}  // namespace

BuiltBvh build_bvh(const SceneView& scene, Buffer<DeviceMemory>& tree, cudaStream_t stream) {
    check_bvh_size(primitive_count(scene));
    return Builder(scene, tree, stream).run();
}

}  // namespace tandem::cuda
