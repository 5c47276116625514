/// Long paths in stages. A block follows several paths for each of its threads. In each stage, a warp takes paths that
/// need the same code: rays to trace, or hits of one class to shade. So most of its threads work, where a thread
/// that follows one path alone waits for the others at each branch.
///
/// Source: the idea is that of S. Laine, T. Karras, T. Aila, "Megakernels Considered Harmful: Wavefront Path Tracing on
/// GPUs", HPG 2013; here the stages are in one kernel, and the states in the shared memory of a block
/// (docs/performance/paths.md). Tested by tests/cuda/staged_paths_test.cpp.
#pragma once

#include "cuda/kernels.h"
#include "cuda/pair_pace.h"
#include "cuda/sort_hits.h"
#include "cuda/staged_memory.h"
#include "cuda/warp_tile.h"

namespace tandem::cuda {

/// The pixels of a window, which blocks take one after the other.
struct PixelQueue {
    WindowTiles tiles;
    std::uint32_t width, height;

    TANDEM_HD PixelQueue(std::uint32_t window_width, std::uint32_t window_height)
        : tiles(tiles_of_window(window_width, window_height, warp_tile(1))),
          width(window_width),
          height(window_height) {}

    /// The next pixel; false if none is left. `next`: a counter that all threads share.
    template <class Lanes>
    TANDEM_HD bool take(unsigned int& next, PixelPlace& at) const {
        do {
            const std::uint32_t place = Lanes::add(next, 1U);
            if (place >= tiles.count * 32) return false;
            at = tiles.pixel(place / 32, place % 32);
        } while (at.x >= width || at.y >= height);
        return true;
    }
};

/// What paths in stages are counted into, in device memory.
struct StagedCounts {
    unsigned long long& rays;  ///< unless counts_rays() is false
    unsigned long long& lost_media;
    unsigned long long& invalid_samples;
};

/// The paths of a block. Needs effects with bounces, and vertices that send at most one shadow ray
/// (samples_one_light()). Each thread of the block has one, and calls run().
template <class Effects, class Real, class Tracer, class Lanes>
class StagedPaths {
  public:
    using Records = PathRecords<Real>;
    using Rare = RarePathRecords<Real>;
    using Lists = StageListsOf<Real>;

    /// `records`, `rare` and `lists` are for `count` paths, and uninitialised; `next_pixel` is as in PixelQueue.
    TANDEM_HD StagedPaths(const Tracer& tracer, const PixelJob& job, std::uint32_t height, const Records& records,
                          Rare* rare, Lists& lists, std::uint32_t count, unsigned int& next_pixel, Vec3d* sums,
                          const StagedCounts& counts)
        : tracer_(tracer),
          job_(job),
          height_(height),
          records_(records),
          rare_(rare),
          lists_(lists),
          count_(count),
          next_pixel_(next_pixel),
          sums_(sums),
          counts_(counts) {}

    /// Follows paths until no pixel is left. Writes the sums of the pixels.
    TANDEM_HD void run(PairPace<Lanes> pace) {
        pace.begin();
        begin();
        bool is_first = true;
        for (std::uint32_t turn = 0;; turn ^= 1) {
            trace_rays(turn, is_first);
            Lanes::wait_for_block();
            count_traced();
            if (!has_work(turn)) break;
            sort_hits<Lanes>(lists_, turn, count_);
            pace.wait();
            Lanes::wait_for_block();
            clear_rays(turn);
            shade_hits(turn);
            Lanes::wait_for_block();
            is_first = false;
        }
        pace.leave();
    }

  private:
    using Threads = ListThreads<Lanes>;

    TANDEM_HD void begin() {
        for (std::uint32_t i = Lanes::thread(); i < count_; i += Lanes::threads()) {
            lists_.rays[0].paths[i] = static_cast<std::uint16_t>(i);
            lists_.places[i] = Lists::no_hit;
        }
        lists_.hit_classes.template compare_materials<Lanes>(tracer_.scene);
        for (std::uint32_t i = Lanes::thread(); i < Lists::classes; i += Lanes::threads()) {
            lists_.class_count[0][i] = 0;
        }
        if (Lanes::thread() == 0) {
            for (auto& rays : lists_.rays) rays.new_count = rays.open_count = rays.shadow_count = 0;
            lists_.rays[0].new_count = count_;
            lists_.rays_taken = lists_.traced = 0;
        }
        Lanes::wait_for_block();
    }
    TANDEM_HD void clear_rays(std::uint32_t turn) {
        if (Lanes::thread() != 0) return;
        typename Lists::Rays& rays = lists_.rays[turn];
        rays.new_count = rays.open_count = rays.shadow_count = 0;
        lists_.rays_taken = 0;
    }
    /// Adds the rays of a turn to all.
    TANDEM_HD void count_traced() {
        if (!counts_rays<Effects>() || Lanes::thread() != 0) return;
        Lanes::add(counts_.rays, static_cast<unsigned long long>(lists_.traced));
        lists_.traced = 0;
    }
    /// Whether a path has a hit, or a ray to trace in the next turn.
    [[nodiscard]] TANDEM_HD bool has_work(std::uint32_t turn) const {
        const typename Lists::Rays& next = lists_.rays[turn ^ 1];
        std::uint32_t waiting = next.new_count | next.open_count | next.shadow_count;
        for (std::uint32_t i = 0; i < Lists::classes; ++i) waiting |= lists_.class_count[turn][i];
        return waiting != 0;
    }

    // Rays

    enum class RayKind { shadow, open, begins };

    /// The first stage: shadow rays of the last turn's vertices, and the next rays of all paths.
    TANDEM_HD void trace_rays(std::uint32_t turn, bool is_first) {
        typename Lists::Rays& rays = lists_.rays[turn];
        while (true) {
            const std::uint32_t warp = Threads::take(lists_.rays_taken);
            // read again for each piece of work, so that they need no registers during it
            const std::uint32_t shadow_count = Lanes::read(rays.shadow_count);
            const std::uint32_t open_count = Lanes::read(rays.open_count), new_count = Lanes::read(rays.new_count);
            const std::uint32_t shadow_warps = Threads::warps_for(shadow_count);
            const std::uint32_t open_warps = shadow_warps + Threads::warps_for(open_count);
            const std::uint32_t warps = open_warps + Threads::warps_for(new_count);
            if (warp >= warps) return;
            const RayKind kind = warp < shadow_warps ? RayKind::shadow
                                 : warp < open_warps ? RayKind::open
                                                     : RayKind::begins;
            const std::uint32_t first_warp = kind == RayKind::shadow ? 0U
                                             : kind == RayKind::open ? shadow_warps
                                                                     : open_warps;
            const std::uint32_t number = (warp - first_warp) * Lanes::count + Lanes::lane();
            if (number >= (kind == RayKind::shadow ? shadow_count : kind == RayKind::open ? open_count : new_count)) {
                continue;
            }
            const std::uint32_t path = kind == RayKind::shadow ? rays.shadows[number]
                                       : kind == RayKind::open ? rays.paths[count_ - 1 - number]
                                                               : rays.paths[number];
            trace(kind, path, turn, is_first);
        }
    }

    TANDEM_HD void trace(RayKind kind, std::uint32_t listed, std::uint32_t turn, bool is_first) {
        const std::uint32_t path = listed & ~std::uint32_t{Lists::path_ends};
        const bool is_shadow = kind == RayKind::shadow;
        Ray<Real> ray;
        PathSource<Real> source;
        Double<Real> farthest = no_hit<Real>().t;
        std::uint32_t light = no_primitive;
        bool has_ray = true;
        if (is_shadow) {
            const typename Rare::Shadow& shadow = rare_[path].shadow;
            ray = shadow.ray;
            source.primitive = shadow.primitive;
            source.inside = shadow.inside;
            light = shadow.light;
            farthest = shadow.t_max;
        } else if (kind == RayKind::open) {
            load_ray(path, ray, source);
        } else {
            has_ray = begin_path(path, is_first, ray);
        }
        const std::uint32_t traced = Lanes::lanes_where(Lanes::together(), has_ray);
        if (!has_ray) return;
        if (counts_rays<Effects>() && Lanes::lane() == Lanes::first(traced)) {
            Lanes::add(lists_.traced, Lanes::size(traced));
        }
        const Closest<Real> hit = search(is_shadow, ray, source, light, farthest);
        Lanes::wait_for(traced);
        typename Lists::Rays& next = lists_.rays[turn ^ 1];
        if (is_shadow) {
            if (hit.primitive == no_primitive) {
                auto record = records_.template load<typename Records::RadianceRecord>(path);
                record.radiance = rare_[path].shadow.lit;
                records_.store(record, path);
            }
            const bool ends = (listed & Lists::path_ends) != 0;
            const std::uint32_t ending = Lanes::lanes_where(traced, ends);
            if (!ends) return;
            next.paths[Threads::append(next.new_count, ending, ending)] = static_cast<std::uint16_t>(path);
            return;
        }
        auto record = records_.template load<typename Records::HitRecord>(path);
        record.t = hit.t;
        record.primitive = hit.primitive;
        records_.store(record, path);
        const bool is_hit = hit.primitive != no_primitive;
        const std::uint32_t of_class =
            is_hit ? lists_.hit_classes.template of<Tracer::kinds>(tracer_.scene, hit.primitive) : Lists::classes;
        const std::uint32_t group = Lanes::lanes_with(traced, of_class);
        const std::uint32_t place =
            Threads::append(is_hit ? lists_.class_count[turn][of_class] : next.new_count, group, traced);
        if (is_hit) {
            lists_.places[path] = static_cast<std::uint16_t>(Lists::place_word(place, of_class));
        } else {
            next.paths[place] = static_cast<std::uint16_t>(path);
        }
    }

    /// The nearest hit of a ray, or what blocks a shadow ray: as is_blocked_by_opaque() without a hierarchy. One search
    /// for both, so that its code exists once.
    TANDEM_HD Closest<Real> search(bool is_shadow, const Ray<Real>& ray, PathSource<Real> source, std::uint32_t light,
                                   const Double<Real>& farthest) const {
        for (std::uint32_t passed = 0;; ++passed) {
            Closest<Real> hit = tracer_.closest(ray, source, true, farthest);
            if (!is_shadow) return hit;
            if (!(hit.t < farthest)) hit.primitive = no_primitive;
            if (hit.primitive == no_primitive || passed + 1 == max_masked_hits) return hit;
            const bool passes =
                hit.primitive == light ||
                (Effects::has(Effect::cutouts) && !is_opaque_at<Tracer::kinds>(tracer_.scene, ray, source, hit, true));
            if (!passes) return hit;
            source.last_masked = hit;
        }
    }

    TANDEM_HD void load_ray(std::uint32_t path, Ray<Real>& ray, PathSource<Real>& source) const {
        const auto record = records_.template load<typename Records::RayRecord>(path);
        ray = record.ray;
        source.primitive = record.primitive;
        source.inside = record.has(Records::RayRecord::is_inside);
        if (Effects::has(Effect::cutouts) && record.has(Records::RayRecord::has_origin)) {
            source.last_masked.t = records_.template load<typename Records::DensityRecord>(path).masked_t;
            source.last_masked.primitive =
                records_.template load<typename Records::OriginRecord>(path).masked_primitive;
        }
    }

    /// Ends a path, and begins the next one in its place, with a camera ray. False if no pixel is left.
    TANDEM_HD bool begin_path(std::uint32_t path, bool is_first, Ray<Real>& ray) {
        PixelPlace at = {0, 0};
        std::uint32_t sample = job_.samples;
        PixelSum<Real> pixel;
        if (!is_first) {
            const auto hit = records_.template load<typename Records::HitRecord>(path);
            auto seen = records_.template load<typename Records::RadianceRecord>(path);
            at = {seen.pixel & 0xFFFF, seen.pixel >> 16};
            if (hit.primitive == no_primitive) {
                const auto record = records_.template load<typename Records::RayRecord>(path);
                auto state = load_path<Effects>(tracer_.scene, records_, rare_[path], path, record);
                see_background(tracer_.scene, true, state, seen.radiance);
            }
            pixel.sum = rare_[path].sum;
            add(seen.radiance, pixel);
            if (pixel.invalid != 0) Lanes::add(counts_.invalid_samples, 1ULL);
            sample = hit.sample + 1;
            if (sample >= job_.samples) {
                sums_[static_cast<std::size_t>(at.y) * job_.width + at.x] = pixel.sum;
                pixel.sum = {};
            }
        }
        if (sample >= job_.samples) {
            if (!PixelQueue(job_.width, height_).template take<Lanes>(next_pixel_, at)) return false;
            sample = 0;
        }
        ray =
            sample_ray<Effects, Real>(job_, sample_of<Real>(job_, at.x, at.y, job_.first_sample + sample), at.x, at.y);
        const Real zero(0.0F);
        records_.store(typename Records::RayRecord{ray, no_primitive, 0}, path);
        records_.store(typename Records::HitRecord{Double<Real>(0.0), no_primitive, sample}, path);
        records_.store(typename Records::RadianceRecord{{zero, zero, zero}, at.y << 16 | at.x}, path);
        rare_[path].sum = pixel.sum;
        return true;
    }

    // Hits

    /// The second stage: surfaces, lights and the next rays.
    TANDEM_HD void shade_hits(std::uint32_t turn) {
        const std::uint32_t warps = lists_.class_warps[Lists::classes];
        while (true) {
            const std::uint32_t warp = Threads::take(lists_.hits_taken);
            if (warp >= warps) return;
            std::uint32_t of_class = 0;
            for (std::uint32_t step = Lists::classes / 2; step > 0; step /= 2) {
                if (lists_.class_warps[of_class + step] <= warp) of_class += step;
            }
            const std::uint32_t number =
                lists_.class_start[of_class] + (warp - lists_.class_warps[of_class]) * Lanes::count + Lanes::lane();
            if (number < lists_.class_start[of_class + 1]) shade(lists_.hits[number], turn ^ 1);
        }
    }

    [[nodiscard]] TANDEM_HD Closest<Real> hit_of(std::uint32_t path) const {
        const auto hit = records_.template load<typename Records::HitRecord>(path);
        return {hit.t, hit.primitive};
    }
    [[nodiscard]] TANDEM_HD SampleId<Real> sample_at(std::uint32_t path) const {
        const auto hit = records_.template load<typename Records::HitRecord>(path);
        const auto seen = records_.template load<typename Records::RadianceRecord>(path);
        return sample_of<Real>(job_, seen.pixel & 0xFFFF, seen.pixel >> 16, job_.first_sample + hit.sample);
    }

    /// The vertex of a path, and the light that its surface emits. False for a masked hit.
    TANDEM_HD bool enter(std::uint32_t path, PathVertex<Effects, Real>& at) {
        const SceneView& scene = tracer_.scene;
        const auto ray = records_.template load<typename Records::RayRecord>(path);
        auto state = load_path<Effects>(scene, records_, rare_[path], path, ray);
        auto seen = records_.template load<typename Records::RadianceRecord>(path);
        bool found = true;
        enter_vertex<Effects, Tracer::kinds>(scene, Effects::limits(job_.limits), hit_of(path), found, state,
                                             seen.radiance, at);
        records_.store(seen, path);
        store_throughput(state, records_, path);
        return found;
    }

    /// Adds the light that the surface reflects. True if it waits for a shadow ray.
    TANDEM_HD bool add_light(std::uint32_t path, const PathVertex<Effects, Real>& at) {
        const SceneView& scene = tracer_.scene;
        const auto ray = records_.template load<typename Records::RayRecord>(path);
        const Vec3<Double<Real>> position = path_detail::point_of(ray.ray, hit_of(path).t);
        const LitVertex<Real> lit = {at.surface.surface, at.surface.point, position,    at.shading.to_viewer,
                                     at.followed,        sample_at(path),  ray.vertex()};
        const Vec3<Real> ambient = ambient_light(scene, lit);
        const bool is_lit = scatters<Effects>(at.surface.surface.reflectance.lobes);
        IncidentLight<Real> light;
        if (is_lit) light = sample_one_light<Effects>(scene, lit, true);
        Lanes::reread();
        auto seen = records_.template load<typename Records::RadianceRecord>(path);
        const Vec3<Real> throughput = records_.template load<typename Records::ThroughputRecord>(path).throughput;
        const auto with = [&](const Vec3<Real>& reflected) { return seen.radiance + throughput * reflected; };
        bool has_shadow = false;
        if (is_lit && Effects::has(Effect::shadows) && needs_shadow_ray(light, true)) {
            const ShadowRay<Real> shadow =
                spawn_shadow_ray(at.surface.point, light.position_or_direction, light.primitive, light.is_far);
            has_shadow = shadow.active;
            if (has_shadow) {
                const Vec3<Real> lit_radiance = with(ambient + light.reflected);
                rare_[path].shadow = {shadow.ray,          shadow.t_max, shadow.source.primitive,
                                      shadow.source.light, lit_radiance, shadow.source.inside};
            }
            light.reflected = black<Real>();
        }
        seen.radiance = with(is_lit ? ambient + light.reflected : ambient);
        records_.store(seen, path);
        return has_shadow;
    }

    /// What a step needs of a path is read from its records in that step, so that it takes no registers in the others.
    TANDEM_HD void shade(std::uint32_t path, std::uint32_t next_turn) {
        const std::uint32_t together = Lanes::together();
        const SceneView& scene = tracer_.scene;
        PathVertex<Effects, Real> at;
        const bool found = enter(path, at);
        Lanes::reread();
        const bool has_shadow = found && add_light(path, at);
        Lanes::reread();
        const auto ray = records_.template load<typename Records::RayRecord>(path);
        auto state = load_path<Effects>(scene, records_, rare_[path], path, ray, true);
        const bool is_lost = leave_vertex<Effects>(scene, Effects::limits(job_.limits), sample_at(path), ray.vertex(),
                                                   hit_of(path), found, at, state);
        if (is_lost) Lanes::add(counts_.lost_media, 1ULL);
        if (state.alive) store_path<Effects>(scene, state, ray.vertex() + 1U, records_, rare_[path], path);
        Lanes::wait_for(together);

        // a path that ends begins anew at once, or when its shadow ray has been traced
        typename Lists::Rays& next = lists_.rays[next_turn];
        const auto listed = static_cast<std::uint16_t>(path);
        const std::uint32_t shadows = Lanes::lanes_where(together, has_shadow);
        if (has_shadow) {
            next.shadows[Threads::append(next.shadow_count, shadows, shadows)] =
                static_cast<std::uint16_t>(state.alive ? listed : listed | Lists::path_ends);
        }
        Lanes::wait_for(together);
        const bool begins = !state.alive && !has_shadow;
        const bool is_listed = state.alive || begins;
        const std::uint32_t all_listed = Lanes::lanes_where(together, is_listed);
        if (!is_listed) return;
        const std::uint32_t group = Lanes::lanes_with(all_listed, begins ? 1U : 0U);
        const std::uint32_t place = Threads::append(begins ? next.new_count : next.open_count, group, all_listed);
        next.paths[begins ? place : count_ - 1 - place] = listed;
    }

    const Tracer& tracer_;
    const PixelJob& job_;
    std::uint32_t height_;
    Records records_;
    Rare* rare_;
    Lists& lists_;
    std::uint32_t count_;
    unsigned int& next_pixel_;
    Vec3d* sums_;
    StagedCounts counts_;
};

}  // namespace tandem::cuda
