/// The kernels for one instruction set. Included by kernels_v2.cpp, kernels_v3.cpp and kernels_v4.cpp, each compiled
/// for its own.
#pragma once

#include "cpu/embree_tracer.h"
#include "cpu/kernels.h"
#include "tandem/math/lanes.h"

namespace tandem {

/// One pixel per lane, along rows.
template <class Isa, class Tracer>
std::uint64_t render_pixels(const Tracer& tracer, const SceneView& scene, const PixelJob& job, const Tile& tile,
                            Vec3d* sums) {
    using Real = Lanes<float, Isa>;
    using Word = Lanes<std::uint32_t, Isa>;
    constexpr std::uint32_t width = Real::size;
    std::uint64_t invalid = 0;
    for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
        for (std::uint32_t x = tile.x0; x < tile.x1; x += width) {
            const std::uint32_t used = tile.x1 - x < width ? tile.x1 - x : width;
            const Word lane = lane_index(Word(0U));
            const PixelSum<Real> pixel =
                render_pixel<Real>(tracer, scene, job, Word(x) + lane, Word(y), lane < Word(used));
            Vec3d* row = sums + static_cast<std::size_t>(y) * job.width + x;
            for (std::uint32_t i = 0; i < used; ++i) {
                const int l = static_cast<int>(i);
                row[i] = {pixel.sum.x[l], pixel.sum.y[l], pixel.sum.z[l]};
                invalid += pixel.invalid[l];
            }
        }
    }
    return invalid;
}

template <class Isa>
std::uint64_t render_tile(const CpuSceneView& view, const PixelJob& job, const Tile& tile, Vec3d* sums) {
    if (view.embree != nullptr) return render_pixels<Isa>(EmbreeTracer{view}, view.scene, job, tile, sums);
    return render_pixels<Isa>(LoopTracer{view.scene}, view.scene, job, tile, sums);
}

/// Do the rays run alike? Then a packet is faster than its rays one by one. One origin, and directions whose signs
/// agree: true of camera rays, and cheap to see.
template <class Isa>
TANDEM_HD bool is_coherent(const Ray<Lanes<float, Isa>>& rays) {
    using Real = Lanes<float, Isa>;
    const auto same = [](const Real& a) { return a == Real(a[0]); };
    const auto same_sign = [](const Real& a) { return select(LaneMask<Isa>(a[0] < 0.0F), a, -a) <= Real(0.0F); };
    return all(same(rays.origin.x) && same(rays.origin.y) && same(rays.origin.z) && same_sign(rays.direction.x) &&
               same_sign(rays.direction.y) && same_sign(rays.direction.z));
}

/// Lane i holds component(i), for i below `used`; the other lanes repeat lane 0.
template <class Lane, class Component>
TANDEM_HD Lane gather(std::size_t used, Component component) {
    return Lane::from([&](int lane) TANDEM_INLINE_LAMBDA {
        const auto i = static_cast<std::size_t>(lane);
        return component(i < used ? i : 0);
    });
}

/// Rays [first, first + used) of a job, as a packet.
template <class Isa>
TANDEM_HD Ray<Lanes<float, Isa>> gather_rays(const TraceJob& job, std::size_t first, std::size_t used) {
    const Ray<float>* rays = job.rays.data() + first;
    const auto load = [&](auto component) TANDEM_INLINE_LAMBDA {
        return gather<Lanes<float, Isa>>(used, [&](std::size_t i)
                                                   TANDEM_INLINE_LAMBDA { return component(rays[i]); });
    };
    return {{load([](const Ray<float>& r) { return r.origin.x; }), load([](const Ray<float>& r) { return r.origin.y; }),
             load([](const Ray<float>& r) { return r.origin.z; })},
            {load([](const Ray<float>& r) { return r.direction.x; }),
             load([](const Ray<float>& r) { return r.direction.y; }),
             load([](const Ray<float>& r) { return r.direction.z; })}};
}

/// What a job asks of a tracer, for one ray and for a packet: the nearest hits of rays that leave nothing, ...
template <class Isa>
struct AskNearest {
    using Real = Lanes<float, Isa>;
    template <class Tracer>
    TANDEM_HD static void one(const Tracer& tracer, const TraceJob& job, std::size_t i, bool active) {
        write(job, i, tracer.closest(job.rays[i], NoSource{}, active));
    }
    template <class Tracer>
    TANDEM_HD static void packet(const Tracer& tracer, const TraceJob& job, const Ray<Real>& rays, std::size_t first,
                                 std::size_t used, const LaneMask<Isa>& active) {
        write(job, first, used, tracer.closest(rays, NoSource{}, active));
    }
    TANDEM_HD static void write(const TraceJob& job, std::size_t i, const Closest<float>& closest) {
        job.hits[i] = to_hit(closest);
        if (!job.wide_t.empty()) job.wide_t[i] = closest.primitive == no_primitive ? 0 : closest.t;
    }
    TANDEM_HD static void write(const TraceJob& job, std::size_t first, std::size_t used, const Closest<Real>& closest) {
        for (std::size_t i = 0; i < used; ++i) {
            const int lane = static_cast<int>(i);
            write(job, first + i, {closest.t[lane], closest.primitive[lane]});
        }
    }
};

/// ... of rays that leave surfaces, ...
template <class Isa>
struct AskNearestFromSurface : AskNearest<Isa> {
    using Real = Lanes<float, Isa>;
    template <class Tracer>
    TANDEM_HD static void one(const Tracer& tracer, const TraceJob& job, std::size_t i, bool active) {
        AskNearest<Isa>::write(job, i, tracer.closest(job.rays[i], job.sources[i], active));
    }
    template <class Tracer>
    TANDEM_HD static void packet(const Tracer& tracer, const TraceJob& job, const Ray<Real>& rays, std::size_t first,
                                 std::size_t used, const LaneMask<Isa>& active) {
        Source<Real> source;
        gather_sources(job, first, used, source);
        AskNearest<Isa>::write(job, first, used, tracer.closest(rays, source, active));
    }
    TANDEM_HD static void gather_sources(const TraceJob& job, std::size_t first, std::size_t used,
                                         Source<Real>& source) {
        if (job.sources.empty()) return;
        using Word = Lanes<std::uint32_t, Isa>;
        const RaySource* sources = job.sources.data() + first;
        source.primitive = gather<Word>(used, [&](std::size_t i) { return sources[i].primitive; });
        source.inside = gather<Word>(used, [&](std::size_t i) { return std::uint32_t{sources[i].inside}; }) != Word(0U);
    }
};

/// ... or whether shadow rays are stopped.
template <class Isa>
struct AskOccluded {
    using Real = Lanes<float, Isa>;
    template <class Tracer>
    TANDEM_HD static void one(const Tracer& tracer, const TraceJob& job, std::size_t i, bool active) {
        ShadowSource<float> source;
        if (!job.sources.empty()) static_cast<RaySource&>(source) = job.sources[i];
        source.light = job.ends[i].light;
        write(job, i, tracer.occluded(job.rays[i], job.ends[i].t, source, active));
    }
    template <class Tracer>
    TANDEM_HD static void packet(const Tracer& tracer, const TraceJob& job, const Ray<Real>& rays, std::size_t first,
                                 std::size_t used, const LaneMask<Isa>& active) {
        const RayEnd* ends = job.ends.data() + first;
        ShadowSource<Real> source;
        AskNearestFromSurface<Isa>::gather_sources(job, first, used, source);
        source.light = gather<Lanes<std::uint32_t, Isa>>(used, [&](std::size_t i) { return ends[i].light; });
        const auto t_max = gather<Lanes<double, Isa>>(used, [&](std::size_t i) { return ends[i].t; });
        const LaneMask<Isa> occluded = tracer.occluded(rays, t_max, source, active);
        for (std::size_t i = 0; i < used; ++i) write(job, first + i, occluded[static_cast<int>(i)]);
    }
    TANDEM_HD static void write(const TraceJob& job, std::size_t i, bool occluded) {
        job.hits[i] = {0, occluded ? some_primitive : no_primitive};
        if (!job.wide_t.empty()) job.wide_t[i] = 0;
    }
};

template <class Isa, class Ask, class Tracer>
std::uint64_t trace_rays(const Tracer& tracer, bool always_packets, const TraceJob& job) {
    using Real = Lanes<float, Isa>;
    constexpr std::size_t width = Real::size;
    const std::size_t count = job.rays.size();
    std::uint64_t rejected = 0;
    for (std::size_t first = 0; first < count; first += width) {
        const std::size_t used = count - first < width ? count - first : width;
        const Ray<Real> packet = gather_rays<Isa>(job, first, used);
        const LaneMask<Isa> traceable = is_traceable(packet);
        for (std::size_t i = 0; i < used; ++i) rejected += traceable[static_cast<int>(i)] ? 0U : 1U;
        if (always_packets || is_coherent(packet)) {
            Ask::packet(tracer, job, packet, first, used, traceable);
        } else {
            for (std::size_t i = 0; i < used; ++i) {
                Ask::one(tracer, job, first + i, traceable[static_cast<int>(i)]);
            }
        }
    }
    return rejected;
}

template <class Isa, class Ask>
std::uint64_t trace_as(const CpuSceneView& view, const TraceJob& job) {
    if (view.embree != nullptr) return trace_rays<Isa, Ask>(EmbreeTracer{view}, false, job);
    return trace_rays<Isa, Ask>(LoopTracer{view.scene}, true, job);
}

template <class Isa>
std::uint64_t trace(const CpuSceneView& view, const TraceJob& job) {
    if (!job.ends.empty()) return trace_as<Isa, AskOccluded<Isa>>(view, job);
    if (!job.sources.empty()) return trace_as<Isa, AskNearestFromSurface<Isa>>(view, job);
    return trace_as<Isa, AskNearest<Isa>>(view, job);
}

template <class Isa>
inline constexpr CpuKernels cpu_kernels = {Isa::name, render_tile<Isa>, trace<Isa>, intersect_callback<Isa>,
                                           occluded_callback<Isa>};

}  // namespace tandem
