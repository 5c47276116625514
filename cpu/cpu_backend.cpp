#include "cpu/cpu_backend.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/version.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <vector>

#include "cpu/embree_handles.h"
#include "cpu/group_hierarchy.h"
#include "cpu/instruction_sets.h"
#include "cpu/size_layers.h"
#include "tandem/base/error.h"
#include "tandem/base/memory.h"
#include "tandem/base/seconds.h"
#include "tandem/compile/crossed_boxes.h"
#include "tandem/compile/derive.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/kernel/first_hit.h"
#include "tandem/kernel/moments.h"
#include "tandem/math/accurate_functions.h"
#include "tandem/math/fp_environment.h"
#include "tandem/math/lengths.h"
#include "tandem/render/complete_planes.h"
#include "tandem/render/pixel_job.h"
#include "tandem/render/ray_coherence.h"
#include "tandem/render/ready_frame.h"
#include "tandem/render/traced_job.h"

namespace tandem {

namespace {

/// Up to this number of primitives a packet tests all of them; for more, it queries Embree
/// (docs/performance/hierarchies.md).
constexpr std::size_t loop_limit = 24;

/// The least memory that Embree's hierarchy takes while it is built; we measured 115 bytes with Embree 3.13.
constexpr std::size_t bvh_bytes_per_primitive = 100;

/// From this number of primitives on, single rays may go through a hierarchy of groups (docs/performance/cpu.md). Its
/// build raised the peak of the memory by 117 bytes a primitive, for three million spheres and for 1.3 million
/// triangles of a mesh.
constexpr std::size_t least_for_groups = 20'000;
constexpr std::size_t group_bytes_per_primitive = 120;

/// Whether neighbours in the list are neighbours in a mesh: of up to 64 pairs, most share a corner.
bool are_connected(const std::vector<Triangle>& triangles) {
    const std::size_t step = triangles.size() / 64 + 1;
    std::size_t pairs = 0, connected = 0;
    for (std::size_t i = 1; i < triangles.size(); i += step, ++pairs) {
        const Triangle &a = triangles[i - 1], &b = triangles[i];
        const auto is_of_b = [&b](const Vec3f& corner) { return corner == b.v0 || corner == b.v1 || corner == b.v2; };
        if (is_of_b(a.v0) || is_of_b(a.v1) || is_of_b(a.v2)) ++connected;
    }
    return 2 * connected > pairs;
}

/// Numbers of boxes that a ray crosses (crossed_boxes.h) from which on single rays among loose triangles go through
/// groups, and the rays of wide packets one by one (docs/performance/cpu.md).
constexpr double many_boxes = 6, very_many_boxes = 100;
/// A packet is wide if packet_width() is more than this many times the distance between neighbouring primitives.
/// Measured for 16 and 8 rays.
constexpr double wide_packet(int rays) { return rays > 8 ? 6 : 3.5; }

/// Whether single rays are faster through groups: in large scenes nearly all of whose primitives are spheres, triangles
/// of meshes, or triangles of which a ray passes close to many. A guess, which affects only the speed.
bool groups_pay(const PreparedScene& scene, double crossed, Tier tier) {
    const std::size_t count = primitive_count(scene);
    const bool embree_decides = tier == Tier::fast && scene.triangles.size() + scene.quads.size() > 0;
    if (count < least_for_groups || embree_decides) return false;
    const bool triangles_pay = crossed > many_boxes || are_connected(scene.triangles);
    return 10 * (scene.spheres.size() + (triangles_pay ? scene.triangles.size() : 0)) > 9 * count;
}

class CpuScene final : public ResidentScene {
  public:
    CpuScene(const std::shared_ptr<const PreparedScene>& scene, Tier tier, RTCDevice device, const TierKernels& kernels)
        : ResidentScene(tier),
          copies_(scene->copies),
          scene_(copies_.empty() ? scene : std::make_shared<PreparedScene>(without_copies(*scene))) {
        const Stopwatch watch;
        const auto count = static_cast<std::uint32_t>(primitive_count(*scene_));
        view_.scene = tandem::view(*scene_);
        if (count > loop_limit) build(device, kernels, count);
        times_.build = watch.seconds();
    }

    /// Includes the time for groups, once there are any.
    [[nodiscard]] PhaseTimes load_times() const override {
        PhaseTimes times = times_;
        times.build += group_seconds_;
        return times;
    }
    [[nodiscard]] const PreparedScene& prepared() const { return *scene_; }
    /// Whether trace() is faster if coherent rays are traced one by one too. A guess, which affects only the speed.
    [[nodiscard]] bool splits_packets(const TraceJob& job) const {
        return std::isfinite(widest_packet_) && packet_width(job.rays, view_.frame.bounds) > widest_packet_;
    }
    [[nodiscard]] const std::vector<PrimitiveCopy>& copies() const { return copies_; }
    [[nodiscard]] const CpuSceneView& view() const { return view_; }

    /// The scene for rays that kernels trace one by one: those that are not coherent, or all if packets are split. The
    /// first call makes the groups, in scenes where they pay and if there is memory: frames do not need them, since
    /// they trace packets. Not to be called in a TBB task.
    [[nodiscard]] const CpuSceneView& view_for_single_rays(RTCDevice device, tbb::task_arena& arena) {
        if (!groups_pay_) return view_;
        std::call_once(groups_made_, [&] {
            const Stopwatch watch;
            const std::size_t count = primitive_count(*scene_);
            try {
                require_memory(count * group_bytes_per_primitive, fmt::format("the groups of {} primitives", count));
                arena.execute([&] {
                    const CutPrimitives cut =
                        if_it_fits(cut_triangles(view_.scene, view_.frame.bounds), count, group_bytes_per_primitive);
                    groups_.emplace(device, view_, cut);
                });
            } catch (const EnvironmentError&) {  // the scene has another hierarchy
            }
            group_seconds_ = watch.seconds();
        });
        return groups_ ? groups_->view() : view_;
    }

  private:
    void build(RTCDevice device, const TierKernels& kernels, std::uint32_t count) {
        require_memory(count * bvh_bytes_per_primitive, fmt::format("the hierarchy of {} primitives", count));
        const std::uint32_t triangles = view_.scene.triangle_count, quads = view_.scene.quad_count;
        view_.first_id[embree_quads] = count - quads;
        view_.first_id[embree_triangles] = count - quads - triangles;
        view_.first_id[our_primitives] = 0;
        const std::vector<SizeLayer> layers = divide_by_size(view_.scene);
        smaller_.assign(layers.size() - 1, view_);
        for (std::size_t i = 0; i < layers.size(); ++i) {
            CpuSceneView& view = i == 0 ? view_ : smaller_[i - 1];
            view.frame = make_structure_frame(layers[i].bounds);
            view.sizes = layers[i].sizes;
            if (i < smaller_.size()) view.smaller = &smaller_[i];
            build_layer(device, kernels, count, view, smaller_.empty());
        }
        const double crossed = crossed_boxes(view_.scene, view_.frame.bounds);
        groups_pay_ = smaller_.empty() && groups_pay(*scene_, crossed, tier());  // groups have one layer
        if (groups_pay_ && may_cut_triangles(view_.scene, view_.frame.bounds)) {
            widest_packet_ = 0;
        } else if (groups_pay_ && crossed > very_many_boxes) {
            const Vec3f extent = view_.frame.bounds.upper - view_.frame.bounds.lower;
            widest_packet_ = wide_packet(kernels.packet_rays) * max_norm(widen(extent)) / accurate_cbrt(count);
        }
    }

    void build_layer(RTCDevice device, const TierKernels& kernels, std::uint32_t count, CpuSceneView& view,
                     bool is_whole_scene) {
        const EmbreeScene& embree = embree_.emplace_back(rtcNewScene(device));
        // Embree's 32-bit indices count the floats of the faces
        const std::size_t most = 0xFFFFFFFFU / (sizeof(Quad) / sizeof(float));
        const bool own_faces =
            tier() != Tier::fast || !is_whole_scene || scene_->triangles.size() > most || scene_->quads.size() > most;
        const std::uint32_t ours = own_faces ? count : view.first_id[embree_triangles];
        if (is_whole_scene) cut_into_pieces(view, ours);
        add_primitives(device, kernels, embree.get(), view, ours);
        if (!own_faces) {
            add_faces(device, kernels, embree.get(), view, embree_triangles, scene_->triangles);
            add_faces(device, kernels, embree.get(), view, embree_quads, scene_->quads);
        }
        rtcCommitScene(embree.get());
        check_embree(device, "building the acceleration structure");
        view.embree = embree.get();
    }

    /// The pieces of `count` primitives, or none if there is no memory for a hierarchy of them.
    static CutPrimitives if_it_fits(CutPrimitives cut, std::size_t count, std::size_t bytes_each) {
        const std::size_t pieces = cut.further.size();
        try {
            if (pieces > 0) {
                require_memory((count + pieces) * bytes_each, fmt::format("the hierarchy of {} pieces", pieces));
            }
        } catch (const EnvironmentError&) {
            return {};
        }
        return cut;
    }

    /// Cuts needles among the primitives [0, count), if there is memory for their pieces.
    void cut_into_pieces(CpuSceneView& view, std::uint32_t count) {
        cut_ = if_it_fits(cut_primitives(view.scene, count, view.frame.bounds), count, bvh_bytes_per_primitive);
        if (cut_.further.empty()) return;
        view.cut = &cut_;
        view.first_piece = count;
    }

    /// Those of the primitives [0, count) that belong to the layer, and their pieces, as user geometry.
    static void add_primitives(RTCDevice device, const TierKernels& kernels, RTCScene embree, CpuSceneView& view,
                               std::uint32_t count) {
        if (count == 0) return;
        const std::size_t items = count + (view.cut != nullptr ? view.cut->further.size() : 0);
        const EmbreeGeometry geometry = user_geometry(device, &view, static_cast<std::uint32_t>(items));
        rtcSetGeometryBoundsFunction(geometry.get(), padded_bounds, nullptr);
        rtcSetGeometryIntersectFunction(geometry.get(), kernels.intersect);
        rtcSetGeometryOccludedFunction(geometry.get(), kernels.occluded);
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometryByID(embree, geometry.get(), our_primitives);
    }

    /// Faces as Embree's own geometry, which reads their corners in place.
    template <class Face>
    static void add_faces(RTCDevice device, const TierKernels& kernels, RTCScene embree, CpuSceneView& view,
                          GeometryId id, const std::vector<Face>& faces) {
        if (faces.empty()) return;
        constexpr bool is_quad = std::is_same_v<Face, Quad>;
        const EmbreeGeometry geometry(
            rtcNewGeometry(device, is_quad ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE));
        check_embree(device, "making a scene");
        // of a face, not of a corner: with a stride of one float, indices reach the corners of both kinds
        constexpr std::size_t floats = sizeof(Face) / sizeof(float);
        rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, faces.data(), 0,
                                   sizeof(float), faces.size() * floats);
        // Embree splits a quad along the diagonal of its corners 1 and 3; ours is that of v0 and v2
        constexpr auto corners =
            is_quad ? std::array<std::uint32_t, 4>{1, 2, 3, 0} : std::array<std::uint32_t, 4>{0, 1, 2};
        constexpr std::size_t corner_count = is_quad ? 4 : 3;
        auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, is_quad ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3,
            corner_count * sizeof(std::uint32_t), faces.size()));
        check_embree(device, "naming the corners of faces");
        for (std::size_t face = 0; face < faces.size(); ++face) {
            for (std::size_t c = 0; c < corner_count; ++c) {
                *indices++ = static_cast<std::uint32_t>(face * floats) + corners[c] * 3U;
            }
        }
        rtcSetGeometryUserData(geometry.get(), &view);
        rtcSetGeometryIntersectFilterFunction(geometry.get(), kernels.filter_nearest);
        rtcSetGeometryOccludedFilterFunction(geometry.get(), kernels.filter_any);
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometryByID(embree, geometry.get(), id);
    }

    static void padded_bounds(const RTCBoundsFunctionArguments* args) {
        const auto& view = *static_cast<const CpuSceneView*>(args->geometryUserPtr);
        const std::uint32_t item = args->primID;
        Aabb box = item >= view.first_piece ? piece_bounds(view.scene, view.cut->further[item - view.first_piece])
                   : view.cut != nullptr && view.cut->counts[item] > 1
                       ? piece_bounds(view.scene, view.cut->first_piece(0, item))
                       : primitive_bounds(view.scene, item);
        box = view.sizes.contains(box) ? pad(box, view.frame.padding) : Aabb{};  // Embree leaves empty boxes out
        *args->bounds_o = {box.lower.x, box.lower.y, box.lower.z, 0, box.upper.x, box.upper.y, box.upper.z, 0};
    }

    std::vector<PrimitiveCopy> copies_;  ///< removed from the scene
    std::shared_ptr<const PreparedScene> scene_;
    CpuSceneView view_{};
    std::vector<CpuSceneView> smaller_;  ///< the layers after the first
    std::vector<EmbreeScene> embree_;    ///< of each layer
    CutPrimitives cut_;
    PhaseTimes times_;

    bool groups_pay_ = false;
    double widest_packet_ =
        std::numeric_limits<double>::infinity();  ///< wider ones are slower than single rays; metres
    std::once_flag groups_made_;
    std::optional<GroupHierarchy> groups_;
    std::atomic<double> group_seconds_ = 0;
};

class CpuBackend final : public Backend {
  public:
    explicit CpuBackend(const BackendOptions& options)
        : set_(choose_instruction_set(options.instruction_set)), tile_size_(checked_tile_size(options.tile_size)) {
        const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
        if (options.threads < 0) throw InputError("the number of threads must be 0 (one per core) or more");
        // More threads than cores are allowed: results do not depend on their number, as tests check. The control is
        // made only then, because the lowest value of all backends applies to the whole process.
        if (threads > tbb::info::default_concurrency()) {
            parallelism_ = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                                 static_cast<std::size_t>(threads));
        }
        arena_.initialize(threads);
        // TBB starts here, before Embree's first commit can set flush-to-zero in its workers
        arena_.execute([] { tbb::parallel_for(0, 64, [](int) { const DefaultFpEnvironment guard; }); });
        device_ = EmbreeDevice(rtcNewDevice(nullptr));
        if (device_.get() == nullptr) throw EnvironmentError("Embree cannot create a device on this machine");
    }

    [[nodiscard]] std::string name() const override { return "cpu"; }

    [[nodiscard]] Capabilities capabilities() const override {
        const auto version = rtcGetDeviceProperty(device_.get(), RTC_DEVICE_PROPERTY_VERSION);
        return {.device = fmt::format("{} threads, {}", arena_.max_concurrency(), set_.name),
                .description = fmt::format("Embree {}.{}.{}, oneTBB {}.{}", version / 10000, version / 100 % 100,
                                           version % 100, TBB_VERSION_MAJOR, TBB_VERSION_MINOR),
                .exact = true};
    }

    [[nodiscard]] std::shared_ptr<ResidentScene> load(const PreparedScene& scene, Tier tier) override {
        // CpuScene makes its own scene, without the copies
        if (!scene.copies.empty()) {
            return load_shared(std::shared_ptr<const PreparedScene>(std::shared_ptr<void>(), &scene), tier);
        }
        return load_shared(std::make_shared<PreparedScene>(scene), tier);
    }

    [[nodiscard]] std::shared_ptr<ResidentScene> load_shared(const std::shared_ptr<const PreparedScene>& scene,
                                                             Tier tier) override {
        const DefaultFpEnvironment guard;
        if (!scene->instances.empty()) {
            return load_shared(std::make_shared<PreparedScene>(written_out(*scene, only_cuda_keeps_instances)), tier);
        }
        std::shared_ptr<CpuScene> result;
        arena_.execute([&] { result = std::make_shared<CpuScene>(scene, tier, device_.get(), set_.kernels(tier)); });
        return result;
    }

    double trace(ResidentScene& scene, const TraceJob& job) override {
        const DefaultFpEnvironment guard;
        check(job);
        auto& resident = dynamic_cast<CpuScene&>(scene);
        const TierKernels& kernels = set_.kernels(scene.tier());
        const bool splits_packets = resident.splits_packets(job);
        CpuSceneView view = splits_packets || are_scattered(job, resident.view())
                                ? resident.view_for_single_rays(device_.get(), arena_)
                                : resident.view();
        view.splits_packets = splits_packets && view.groups != nullptr;
        return trace_without_copies(resident.copies(), job, [&](const TraceJob& traced) {
            std::atomic<std::uint64_t> rejected = 0;
            const Stopwatch watch;
            arena_.execute([&] {
                tbb::parallel_for(tbb::blocked_range<std::size_t>(0, traced.rays.size(), 1024), [&](const auto& range) {
                    const DefaultFpEnvironment guard_of_task;
                    rejected += kernels.trace(view, part(traced, range.begin(), range.size()));
                });
            });
            const double seconds = watch.seconds();
            if (traced.counters != nullptr) traced.counters->rejected_rays += rejected;
            return seconds;
        });
    }

    [[nodiscard]] std::unique_ptr<PendingFrame> submit(std::shared_ptr<ResidentScene> scene,
                                                       const RenderJob& job) override {
        const DefaultFpEnvironment guard;
        check(job, scene->tier());
        const auto& resident = dynamic_cast<const CpuScene&>(*scene);
        const TierKernels& kernels = set_.kernels(job.tier);
        const PixelJob pixel_job = make_pixel_job(resident.prepared().camera, job);
        RenderResult result;
        const FilmWindow window = window_of(job);
        result.film = Film(window.width, window.height, job.samples, job.planes);
        Vec3d* sums = result.film.sums().data();
        const FilmPlanes planes = result.film.planes();
        const bool one_by_one = planes.variance != nullptr;
        std::vector<Vec3d> one_sample(one_by_one ? result.film.pixel_count() : 0);
        const bool finds_hits = job.planes.has_any(first_hit_planes);
        const PixelJob hit_job = first_hit_job(pixel_job, job.planes);
        const auto tiles = [this](int size) { return (size + tile_size_ - 1) / tile_size_; };
        const int columns = tiles(window.width);
        const EffectMask effects = resident.prepared().effects;
        const std::size_t variant = variant_for(variants, effects);
        std::atomic<std::uint64_t> invalid = 0, lost_media = 0, rays = 0;
        const Stopwatch watch;
        arena_.execute([&] {
            tbb::parallel_for(0, columns * tiles(window.height), [&](int index) {
                const DefaultFpEnvironment guard;
                const Tile tile = tile_at(index % columns, index / columns, window);
                const auto draw = [&](const PixelJob& samples, Vec3d* to) {
                    const TileStats stats = kernels.render_tile[variant](resident.view(), samples, tile, to);
                    invalid += stats.counters.invalid_samples;
                    lost_media += stats.counters.lost_media;
                    rays += stats.rays;
                };
                if (one_by_one) {
                    draw_one_by_one(pixel_job, tile, draw, one_sample.data(), sums, planes.variance);
                } else {
                    draw(pixel_job, sums);
                }
                if (finds_hits) set_.first_hits(job.tier)(resident.view(), hit_job, tile, planes);
            });
        });
        complete_planes(result.film, resident.copies());
        result.stats.seconds.render = watch.seconds();
        result.stats.counters.invalid_samples = invalid;
        result.stats.counters.lost_media = lost_media;
        result.stats.counters.dropped_primitives = resident.prepared().dropped_primitives;
        result.stats.counters.dropped_lights = resident.prepared().dropped_lights;
        result.stats.rays = effects.has_any(counted_ray_effects)
                                ? rays.load()
                                : static_cast<std::uint64_t>(result.film.pixel_count()) * pixel_job.samples;
        result.stats.effects = effects;
        result.stats.carried = variants[variant].effects - effects - host_effects;
        result.stats.variant = fmt::format(
            "{}, {}, {}", set_.name, resident.view().embree != nullptr ? "embree" : "loop", variants[variant].name);
        return std::make_unique<ReadyFrame>(std::move(result));
    }

  private:
    /// Whether kernels will trace rays of the job one by one: a guess, which affects only the speed.
    static bool are_scattered(const TraceJob& job, const CpuSceneView& view) {
        if (view.embree == nullptr || job.coherence == Coherence::coherent) return false;
        return job.coherence == Coherence::incoherent || !are_coherent(job.rays, reach(view.frame.bounds));
    }

    /// Renders the samples of a tile one by one, so that their squares can be added. `one_sample`: a temporary film for
    /// the calls of draw(job, film). The sums have the same bits as from one call for all samples.
    template <class Draw>
    static void draw_one_by_one(const PixelJob& job, const Tile& tile, Draw draw, Vec3d* one_sample, Vec3d* sums,
                                Vec3d* squares) {
        PixelJob one = job;
        one.samples = 1;
        for (std::uint32_t sample = 0; sample < job.samples; ++sample) {
            one.first_sample = job.first_sample + sample;
            draw(one, one_sample);
            for (std::size_t y = tile.y0; y < tile.y1; ++y) {
                for (std::size_t i = y * job.width + tile.x0; i < y * job.width + tile.x1; ++i) {
                    add_sample(one_sample[i], sums[i], squares[i]);
                }
            }
        }
    }

    Tile tile_at(int column, int row, const FilmWindow& window) const {
        const auto first = [this](int index) { return static_cast<std::uint32_t>(index * tile_size_); };
        const auto end = [this](int index, int limit) {
            return static_cast<std::uint32_t>(std::min((index + 1) * tile_size_, limit));
        };
        return {first(column), end(column, window.width), first(row), end(row, window.height)};
    }

    static int checked_tile_size(int size) {
        if (size < 1 || size > 4096)
            throw InputError(fmt::format("the tile size is {}, but must be from 1 to 4096 pixels", size));
        return size;
    }

    const InstructionSet& set_;
    int tile_size_;
    std::unique_ptr<tbb::global_control> parallelism_;  ///< null unless there are more threads than cores
    mutable tbb::task_arena arena_;
    EmbreeDevice device_;
};

}  // namespace

std::unique_ptr<Backend> make_cpu_backend(const BackendOptions& options) {
    return std::make_unique<CpuBackend>(options);
}

std::string why_cpu_unavailable() { return why_no_instruction_set(); }

std::vector<std::string> runnable_instruction_sets() {
    std::vector<std::string> names;
    for (const InstructionSet& set : instruction_sets()) {
        if (set.is_supported()) names.emplace_back(set.name);
    }
    return names;
}

}  // namespace tandem
