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
                          Rare* rare, Lists& lists, std::uint32_t count, unsigned int& next_pixel, Vec3d* sums)
        : tracer_(tracer),
          job_(job),
          pixels_(job.width, height),
          records_(records),
          rare_(rare),
          lists_(lists),
          count_(count),
          next_pixel_(next_pixel),
          sums_(sums) {}

    /// Follows paths until no pixel is left. Writes the sums of the pixels.
    TANDEM_HD void run(PairPace<Lanes> pace) {
        pace.begin();
        begin();
        bool is_first = true;
        for (std::uint32_t turn = 0; has_rays(turn); turn ^= 1) {
            trace_rays(turn, is_first);
            Lanes::wait_for_block();
            sort_hits(turn);
            pace.wait();
            Lanes::wait_for_block();
            clear_rays(turn);
            shade_hits(turn);
            Lanes::wait_for_block();
            is_first = false;
        }
        pace.leave();
    }

    /// Of this thread.
    [[nodiscard]] TANDEM_HD const PixelSum<Real>& counted() const { return counted_; }

  private:
    using Threads = ListThreads<Lanes>;

    TANDEM_HD void begin() {
        for (std::uint32_t i = Lanes::thread(); i < count_; i += Lanes::threads()) {
            lists_.rays[0].paths[i] = static_cast<std::uint16_t>(i);
        }
        lists_.hit_classes.template compare_materials<Lanes>(tracer_.scene);
        clear_classes(0);
        if (Lanes::thread() == 0) {
            for (auto& rays : lists_.rays) rays.new_count = rays.open_count = rays.shadow_count = 0;
            lists_.rays[0].new_count = count_;
            lists_.rays_taken = 0;
        }
        Lanes::wait_for_block();
    }
    TANDEM_HD void clear_classes(std::uint32_t turn) {
        for (std::uint32_t i = Lanes::thread(); i < Lists::classes; i += Lanes::threads()) {
            lists_.class_count[turn][i] = 0;
        }
    }
    TANDEM_HD void clear_rays(std::uint32_t turn) {
        if (Lanes::thread() != 0) return;
        typename Lists::Rays& rays = lists_.rays[turn];
        rays.new_count = rays.open_count = rays.shadow_count = 0;
        lists_.rays_taken = 0;
    }
    [[nodiscard]] TANDEM_HD bool has_rays(std::uint32_t turn) const {
        const typename Lists::Rays& rays = lists_.rays[turn];
        return (rays.new_count | rays.open_count | rays.shadow_count) != 0;
    }

    // Rays

    enum class RayKind { shadow, open, begins };

    /// The first stage: shadow rays of the last turn's vertices, and the next rays of all paths.
    TANDEM_HD void trace_rays(std::uint32_t turn, bool is_first) {
        const typename Lists::Rays& rays = lists_.rays[turn];
        const std::uint32_t shadow_count = rays.shadow_count, open_count = rays.open_count, new_count = rays.new_count;
        const std::uint32_t shadow_warps = Threads::warps_for(shadow_count);
        const std::uint32_t open_warps = shadow_warps + Threads::warps_for(open_count);
        const std::uint32_t warps = open_warps + Threads::warps_for(new_count);
        while (true) {
            const std::uint32_t warp = Threads::take(lists_.rays_taken);
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
            if (!has_ray) lists_.places[path] = Lists::no_hit;
        }
        const std::uint32_t traced = Lanes::lanes_where(Lanes::together(), has_ray);
        if (!has_ray) return;
        count_rays<Effects, Real>(true, counted_.tally.rays);
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
        lists_.places[path] = static_cast<std::uint16_t>(is_hit ? Lists::place_word(place, of_class) : Lists::no_hit);
        if (!is_hit) next.paths[place] = static_cast<std::uint16_t>(path);
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
            counted_.invalid += pixel.invalid;
            sample = hit.sample + 1;
            if (sample >= job_.samples) {
                sums_[static_cast<std::size_t>(at.y) * job_.width + at.x] = pixel.sum;
                pixel.sum = {};
            }
        }
        if (sample >= job_.samples) {
            if (!pixels_.template take<Lanes>(next_pixel_, at)) return false;
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

    /// Orders the hits by their classes.
    TANDEM_HD void sort_hits(std::uint32_t turn) {
        const typename Lists::Rays& rays = lists_.rays[turn];
        const std::uint32_t* counts = lists_.class_count[turn];
        std::uint32_t hits_before = 0, warps_before = 0;
        // every warp computes the starts for itself, so that the block need not wait for one of them
        std::uint32_t start = 0;
        for (std::uint32_t first = 0; first < Lists::classes; first += Lanes::count) {
            const std::uint32_t number = first + Lanes::lane();
            const std::uint32_t hits = Lanes::sum_up_to(counts[number]);
            const std::uint32_t warps = Lanes::sum_up_to(Threads::warps_for(counts[number]));
            start = hits_before + hits - counts[number];
            if (Lanes::thread() < Lanes::count) {
                lists_.class_start[number] = start;
                lists_.class_warps[number] = warps_before + warps - Threads::warps_for(counts[number]);
            }
            hits_before += Lanes::of_lane(Threads::all, hits, Lanes::count - 1);
            warps_before += Lanes::of_lane(Threads::all, warps, Lanes::count - 1);
        }
        if (Lanes::thread() == 0) {
            lists_.class_start[Lists::classes] = hits_before;
            lists_.class_warps[Lists::classes] = warps_before;
            lists_.hits_taken = 0;
        }
        clear_classes(turn ^ 1);
        const std::uint32_t count = rays.new_count + rays.open_count;
        for (std::uint32_t first = Lanes::thread() - Lanes::lane(); first < count; first += Lanes::threads()) {
            const std::uint32_t number = first + Lanes::lane();
            const bool is_in = number < count;
            const std::uint32_t path =
                !is_in ? 0U : rays.paths[number < rays.new_count ? number : count_ - 1 - (number - rays.new_count)];
            const std::uint32_t place = is_in ? lists_.places[path] : Lists::no_hit;
            const std::uint32_t of_class = place % Lists::classes;
            const std::uint32_t class_start = start_of(of_class, start, counts);
            if (place != Lists::no_hit) {
                lists_.hits[class_start + place / Lists::classes] = static_cast<std::uint16_t>(path);
            }
        }
    }
    /// The start of a class, of which each lane of a warp knows one.
    TANDEM_HD std::uint32_t start_of(std::uint32_t of_class, std::uint32_t start, const std::uint32_t* counts) const {
        if constexpr (Lanes::count == Lists::classes) {
            return Lanes::of_lane(Threads::all, start, of_class);
        } else {
            std::uint32_t before = 0;
            for (std::uint32_t i = 0; i < of_class; ++i) before += counts[i];
            return before;
        }
    }

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

    TANDEM_HD void shade(std::uint32_t path, std::uint32_t next_turn) {
        const std::uint32_t together = Lanes::together();
        const SceneView& scene = tracer_.scene;
        const auto ray = records_.template load<typename Records::RayRecord>(path);
        const auto found_hit = records_.template load<typename Records::HitRecord>(path);
        auto seen = records_.template load<typename Records::RadianceRecord>(path);
        auto state = load_path<Effects>(scene, records_, rare_[path], path, ray);
        const Closest<Real> hit = {found_hit.t, found_hit.primitive};
        const SampleId<Real> sample =
            sample_of<Real>(job_, seen.pixel & 0xFFFF, seen.pixel >> 16, job_.first_sample + found_hit.sample);
        const UInt<Real> vertex = ray.vertex();
        const PathLimits limits = Effects::limits(job_.limits);
        bool found = true;
        PathVertex<Effects, Real> at;
        enter_vertex<Effects, Tracer::kinds>(scene, limits, hit, found, state, seen.radiance, at);

        bool has_shadow = false;
        if (found) {
            const Vec3<Double<Real>> position = path_detail::point_of(state.ray, hit.t);
            const LitVertex<Real> lit = {at.surface.surface, at.surface.point, position, at.shading.to_viewer,
                                         at.followed,        sample,           vertex};
            const Vec3<Real> ambient = ambient_light(scene, lit);
            Vec3<Real> reflected = ambient;
            if (scatters<Effects>(at.surface.surface.reflectance.lobes)) {
                const IncidentLight<Real> light = sample_one_light<Effects>(scene, lit, true);
                reflected = ambient + light.reflected;
                if (Effects::has(Effect::shadows) && needs_shadow_ray(light, true)) {
                    const ShadowRay<Real> shadow =
                        spawn_shadow_ray(at.surface.point, light.position_or_direction, light.primitive, light.is_far);
                    has_shadow = shadow.active;
                    if (has_shadow) {
                        rare_[path].shadow = {shadow.ray,
                                              shadow.t_max,
                                              shadow.source.primitive,
                                              shadow.source.light,
                                              seen.radiance + state.throughput * reflected,
                                              shadow.source.inside};
                    }
                    reflected = ambient + black<Real>();
                }
            }
            seen.radiance = seen.radiance + state.throughput * reflected;
        }
        records_.store(seen, path);
        const bool is_lost = leave_vertex<Effects>(scene, limits, sample, vertex, hit, found, at, state);
        counted_.tally.lost_media += is_lost ? 1U : 0U;
        if (state.alive) store_path<Effects>(scene, state, vertex + 1U, records_, rare_[path], path);
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
    PixelQueue pixels_;
    Records records_;
    Rare* rare_;
    Lists& lists_;
    std::uint32_t count_;
    unsigned int& next_pixel_;
    Vec3d* sums_;
    PixelSum<Real> counted_;
};

}  // namespace tandem::cuda
