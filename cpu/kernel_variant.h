/// The kernels of the exact tiers for one instruction set. Included by kernels_v2.cpp, kernels_v3.cpp and
/// kernels_v4.cpp, each compiled for its own.
#pragma once

#include "cpu/embree_tracer.h"
#include "cpu/kernels.h"
#include "cpu/path_pool.h"
#include "cpu/tile_pixels.h"
#include "tandem/math/lanes.h"

namespace tandem {

/// The Reals of a tier: for one ray and for a packet.
template <class OneReal, class PacketReal>
struct TierReals {
    using One = OneReal;
    using Packet = PacketReal;
};
template <class Isa>
using Strict = TierReals<float, Lanes<float, Isa>>;
template <class Isa>
using Precise = TierReals<double, Lanes<double, Isa>>;

// Calls, in this file's own copy: their names do not always tell the instruction set.
template <class Real, class From, class Tracer>
TANDEM_HD_CALL Closest<Real> closest_hit(const Tracer& tracer, const Ray<Real>& ray, const From& source,
                                         const Mask<Real>& active) {
    return tracer.closest(ray, source, active);
}
template <class Real, class Tracer>
TANDEM_HD_CALL Mask<Real> any_hit(const Tracer& tracer, const Ray<Real>& ray, const Double<Real>& t_max,
                                  const ShadowSource<Real>& source, const Mask<Real>& active) {
    return tracer.occluded(ray, t_max, source, active);
}

/// The tracer of a scene, whichever that is, by calls: one copy of each serves the path loop, wherever it asks, and
/// trace(). The plain path loop has its own, inline.
struct CalledTracer {
    static constexpr std::uint32_t kinds = PrimitiveKinds::all;
    static constexpr bool has_hierarchy = true;
    const CpuSceneView& view;

    template <class Real, class From>
    [[nodiscard]] TANDEM_HD Closest<Real> closest(const Ray<Real>& ray, const From& source,
                                                  const Mask<Real>& active) const {
        if (view.embree != nullptr) return closest_hit<Real, From>(EmbreeTracer{view}, ray, source, active);
        return closest_hit<Real, From>(LoopTracer{view.scene}, ray, source, active);
    }
    template <class Real>
    [[nodiscard]] TANDEM_HD Mask<Real> occluded(const Ray<Real>& ray, const Double<Real>& t_max,
                                                const ShadowSource<Real>& source, const Mask<Real>& active) const {
        if (view.embree != nullptr) return any_hit<Real>(EmbreeTracer{view}, ray, t_max, source, active);
        return any_hit<Real>(LoopTracer{view.scene}, ray, t_max, source, active);
    }
};

/// Paths of one vertex: a pixel per lane.
template <class Effects, class Real, class Tracer>
TileStats render_pixels(const Tracer& tracer, const SceneView& scene, const PixelJob& job, const Tile& tile,
                        Vec3d* sums) {
    using Word = UInt<Real>;
    TileStats stats;
    TilePixels<Real> pixels(tile);
    Word x(0U), y(0U);
    while (true) {
        const Mask<Real> used = pixels.next(Mask<Real>(true), x, y);
        if (!any(used)) return stats;
        const auto pixel = render_pixel<Effects, Real>(tracer, scene, job, x, y, used);
        const Word at = y * Word(job.width) + x;
        for (int i = 0; i < Real::size; ++i) {
            if (!used[i]) continue;
            sums[at[i]] = {pixel.sum.x[i], pixel.sum.y[i], pixel.sum.z[i]};
            stats.counters.invalid_samples += pixel.invalid[i];
        }
        stats.add(pixel.tally);
    }
}

/// Paths that go on: a lane that is done takes the next pixel of the tile.
template <class Effects, class Real, class Tracer>
TileStats follow_paths(const Tracer& tracer, const SceneView& scene, const PixelJob& job, const Tile& tile,
                       Vec3d* sums) {
    TileStats stats;
    TilePixels<Real> pixels(tile);
    PathPool<Effects, Real> pool;
    do {
        pool.take(job, [&](const Mask<Real>& free, UInt<Real>& x, UInt<Real>& y) TANDEM_INLINE_LAMBDA {
            const Mask<Real> taken = pixels.next(free, x, y);
            for (int i = 0; i < Real::size; ++i) {
                if (taken[i]) sums[y[i] * job.width + x[i]] = {0.0, 0.0, 0.0};
            }
            return taken;
        });
    } while (pool.step(tracer, scene, job, sums, stats));
    return stats;
}

template <class Reals, std::size_t variant>
TileStats render_tile(const CpuSceneView& view, const PixelJob& job, const Tile& tile, Vec3d* sums) {
    using Effects = EffectSet<variants[variant].effects.bits()>;
    using Real = typename Reals::Packet;
    if constexpr (can_bounce<Effects>()) {
        return follow_paths<Effects, Real>(CalledTracer{view}, view.scene, job, tile, sums);
    } else if constexpr (can_leave_surfaces<Effects>()) {
        return render_pixels<Effects, Real>(CalledTracer{view}, view.scene, job, tile, sums);
    } else {
        if (view.embree != nullptr) {
            return render_pixels<Effects, Real>(EmbreeTracer{view}, view.scene, job, tile, sums);
        }
        return render_pixels<Effects, Real>(LoopTracer{view.scene}, view.scene, job, tile, sums);
    }
}

/// Do the rays run alike? Then a packet is faster than its rays one by one. One origin, and directions whose signs
/// agree: true of camera rays, and cheap to see.
template <class Real>
TANDEM_HD bool is_coherent(const Ray<Real>& rays) {
    const auto same = [](const Real& a) { return a == Real(a[0]); };
    const auto same_sign = [](const Real& a) { return select(Mask<Real>(a[0] < 0), a, -a) <= Real(0.0F); };
    return all(same(rays.origin.x) && same(rays.origin.y) && same(rays.origin.z) && same_sign(rays.direction.x) &&
               same_sign(rays.direction.y) && same_sign(rays.direction.z));
}

/// Lane i holds component(i), for i below `used`; the other lanes repeat lane 0.
template <class Lane, class Component>
TANDEM_HD Lane gather(std::size_t used, Component component) {
    using Scalar = typename RealTraits<Lane>::Scalar;
    return Lane::from([&](int lane) TANDEM_INLINE_LAMBDA {
        const auto i = static_cast<std::size_t>(lane);
        return static_cast<Scalar>(component(i < used ? i : 0));
    });
}

/// Rays [first, first + used) of a job, as a packet.
template <class Packet>
TANDEM_HD Ray<Packet> gather_rays(const TraceJob& job, std::size_t first, std::size_t used) {
    const Ray<float>* rays = job.rays.data() + first;
    const auto load = [&](auto component) TANDEM_INLINE_LAMBDA {
        return gather<Packet>(used, [&](std::size_t i) TANDEM_INLINE_LAMBDA { return component(rays[i]); });
    };
    return {{load([](const Ray<float>& r) { return r.origin.x; }), load([](const Ray<float>& r) { return r.origin.y; }),
             load([](const Ray<float>& r) { return r.origin.z; })},
            {load([](const Ray<float>& r) { return r.direction.x; }),
             load([](const Ray<float>& r) { return r.direction.y; }),
             load([](const Ray<float>& r) { return r.direction.z; })}};
}

template <class Packet>
TANDEM_HD PathSource<Packet> gather_sources(const TraceJob& job, std::size_t first, std::size_t used) {
    using Word = UInt<Packet>;
    if (job.sources.empty()) return {};
    const RaySource* sources = job.sources.data() + first;
    return {{gather<Word>(used, [&](std::size_t i) { return sources[i].primitive; }),
             gather<Word>(used, [&](std::size_t i) { return std::uint32_t{sources[i].inside}; }) != Word(0U)}};
}

// What a job asks of a tracer, for one ray and for a packet: the nearest hits of rays that leave nothing, ...
template <class Reals>
struct AskNearest {
    using One = typename Reals::One;
    using Packet = typename Reals::Packet;
    template <class Tracer>
    TANDEM_HD static void one(const Tracer& tracer, const TraceJob& job, std::size_t i, bool active) {
        write(job, i, tracer.closest(to_real<One>(job.rays[i]), NoSource{}, active));
    }
    template <class Tracer>
    TANDEM_HD static void packet(const Tracer& tracer, const TraceJob& job, const Ray<Packet>& rays, std::size_t first,
                                 std::size_t used, const Mask<Packet>& active) {
        write(job, first, used, tracer.closest(rays, NoSource{}, active));
    }
    TANDEM_HD static void write(const TraceJob& job, std::size_t i, const Closest<One>& closest) {
        job.hits[i] = to_hit(closest);
        if (!job.wide_t.empty()) job.wide_t[i] = closest.primitive == no_primitive ? 0 : to_wide(closest.t);
    }
    TANDEM_HD static void write(const TraceJob& job, std::size_t first, std::size_t used,
                                const Closest<Packet>& closest) {
        for (std::size_t i = 0; i < used; ++i) {
            const int lane = static_cast<int>(i);
            write(job, first + i, {closest.t[lane], closest.primitive[lane]});
        }
    }
};

/// ... of rays that leave surfaces, ...
template <class Reals>
struct AskNearestFromSurface {
    using One = typename Reals::One;
    using Packet = typename Reals::Packet;
    template <class Tracer>
    TANDEM_HD static void one(const Tracer& tracer, const TraceJob& job, std::size_t i, bool active) {
        const PathSource<One> source = {to_real<One>(job.sources[i])};
        AskNearest<Reals>::write(job, i, tracer.closest(to_real<One>(job.rays[i]), source, active));
    }
    template <class Tracer>
    TANDEM_HD static void packet(const Tracer& tracer, const TraceJob& job, const Ray<Packet>& rays, std::size_t first,
                                 std::size_t used, const Mask<Packet>& active) {
        const PathSource<Packet> source = gather_sources<Packet>(job, first, used);
        AskNearest<Reals>::write(job, first, used, tracer.closest(rays, source, active));
    }
};

/// ... or whether shadow rays are stopped.
template <class Reals>
struct AskOccluded {
    using One = typename Reals::One;
    using Packet = typename Reals::Packet;
    template <class Tracer>
    TANDEM_HD static void one(const Tracer& tracer, const TraceJob& job, std::size_t i, bool active) {
        ShadowSource<One> source;
        if (!job.sources.empty()) static_cast<Source<One>&>(source) = to_real<One>(job.sources[i]);
        source.light = job.ends[i].light;
        const auto t_max = constant<Double<One>>(job.ends[i].t);
        write(job, i, tracer.occluded(to_real<One>(job.rays[i]), t_max, source, active));
    }
    template <class Tracer>
    TANDEM_HD static void packet(const Tracer& tracer, const TraceJob& job, const Ray<Packet>& rays, std::size_t first,
                                 std::size_t used, const Mask<Packet>& active) {
        const RayEnd* ends = job.ends.data() + first;
        ShadowSource<Packet> source;
        static_cast<Source<Packet>&>(source) = gather_sources<Packet>(job, first, used);
        source.light = gather<UInt<Packet>>(used, [&](std::size_t i) { return ends[i].light; });
        const auto t_max = gather<Double<Packet>>(used, [&](std::size_t i) { return ends[i].t; });
        const Mask<Packet> occluded = tracer.occluded(rays, t_max, source, active);
        for (std::size_t i = 0; i < used; ++i) write(job, first + i, occluded[static_cast<int>(i)]);
    }
    TANDEM_HD static void write(const TraceJob& job, std::size_t i, bool occluded) {
        job.hits[i] = {0, occluded ? some_primitive : no_primitive};
        if (!job.wide_t.empty()) job.wide_t[i] = 0;
    }
};

/// Returns how many rays were not traceable.
template <class Reals, class Ask, bool always_packets, class Tracer>
std::uint64_t trace_rays(const Tracer& tracer, const TraceJob& job) {
    using Packet = typename Reals::Packet;
    constexpr std::size_t width = Packet::size;
    const std::size_t count = job.rays.size();
    std::uint64_t rejected = 0;
    for (std::size_t first = 0; first < count; first += width) {
        const std::size_t used = count - first < width ? count - first : width;
        const Ray<Packet> packet = gather_rays<Packet>(job, first, used);
        const Mask<Packet> traceable = is_traceable(packet);
        for (std::size_t i = 0; i < used; ++i) rejected += traceable[static_cast<int>(i)] ? 0U : 1U;
        if (always_packets || is_coherent(packet)) {
            Ask::packet(tracer, job, packet, first, used, traceable);
            continue;
        }
        if constexpr (!always_packets) {
            for (std::size_t i = 0; i < used; ++i) {
                Ask::one(tracer, job, first + i, traceable[static_cast<int>(i)]);
            }
        }
    }
    return rejected;
}

template <class Reals, class Ask>
std::uint64_t trace_as(const CpuSceneView& view, const TraceJob& job) {
    const CalledTracer tracer{view};
    return view.embree != nullptr ? trace_rays<Reals, Ask, false>(tracer, job)
                                  : trace_rays<Reals, Ask, true>(tracer, job);
}

template <class Reals>
std::uint64_t trace(const CpuSceneView& view, const TraceJob& job) {
    if (!job.ends.empty()) return trace_as<Reals, AskOccluded<Reals>>(view, job);
    if (!job.sources.empty()) return trace_as<Reals, AskNearestFromSurface<Reals>>(view, job);
    return trace_as<Reals, AskNearest<Reals>>(view, job);
}

template <class Reals>
constexpr TierKernels make_tier_kernels() {
    using One = typename Reals::One;
    using Packet = typename Reals::Packet;
    TierKernels kernels = {{},      trace<Reals>, intersect_callback<One, Packet>, occluded_callback<One, Packet>,
                           nullptr, nullptr};
    [&]<std::size_t... variant>(std::index_sequence<variant...>) {
        ((kernels.render_tile[variant] = render_tile<Reals, variant>), ...);
    }
    (std::make_index_sequence<variant_count>());
    if constexpr (is_fast<One>) {
        kernels.filter_nearest = filter_callback<Search::nearest, One, Packet>;
        kernels.filter_any = filter_callback<Search::any, One, Packet>;
    }
    return kernels;
}

template <class Reals>
inline constexpr TierKernels tier_kernels = make_tier_kernels<Reals>();

}  // namespace tandem
