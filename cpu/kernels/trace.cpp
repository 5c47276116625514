// trace() of one tier for one instruction set.
#include "cpu/kernels/called_tracer.h"
#include "cpu/kernels/tier_reals.h"

namespace tandem {

namespace {

/// Whether the rays are coherent: then a packet is faster than single rays. The test, for a common origin and
/// directions of equal signs, is cheap and holds for camera rays.
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
    return Lane::from([&](int lane) {
        const auto i = static_cast<std::size_t>(lane);
        return static_cast<Scalar>(component(i < used ? i : 0));
    });
}

/// Rays [first, first + used) of a job, as a packet.
template <class Packet>
TANDEM_HD Ray<Packet> gather_rays(const TraceJob& job, std::size_t first, std::size_t used) {
    const Ray<float>* rays = job.rays.data() + first;
    const auto load = [&](auto component) {
        return gather<Packet>(used, [&](std::size_t i) { return component(rays[i]); });
    };
    return {{load([](const Ray<float>& r) { return r.origin.x; }), load([](const Ray<float>& r) { return r.origin.y; }),
             load([](const Ray<float>& r) { return r.origin.z; })},
            {load([](const Ray<float>& r) { return r.direction.x; }),
             load([](const Ray<float>& r) { return r.direction.y; }),
             load([](const Ray<float>& r) { return r.direction.z; })}};
}

template <class Packet>
TANDEM_HD Source<Packet> gather_sources(const TraceJob& job, std::size_t first, std::size_t used) {
    using Word = UInt<Packet>;
    if (job.sources.empty()) return {};
    const RaySource* sources = job.sources.data() + first;
    return {gather<Word>(used, [&](std::size_t i) { return sources[i].primitive; }),
            gather<Word>(used, [&](std::size_t i) { return std::uint32_t{sources[i].inside}; }) != Word(0U)};
}

// The queries of a job, for one ray and for a packet: nearest hits of rays that start in space, ...
template <class Reals>
struct AskNearest {
    using One = typename Reals::One;
    using Packet = typename Reals::Packet;
    struct Sources {
        QuerySource<One> none;
    };
    TANDEM_HD static void add(RayBatch<One>& batch, Sources& sources, const TraceJob& job, std::size_t i, bool active) {
        batch.add(to_real<One>(job.rays[i]), sources.none, active);
    }
    template <class Tracer>
    TANDEM_HD static void each(const Tracer& tracer, const TraceJob& job, const RayBatch<One>& batch,
                               std::size_t first) {
        Closest<One> hits[RayBatch<One>::most];
        tracer.closest(batch, hits);
        for (int i = 0; i < batch.count; ++i) write(job, first + static_cast<std::size_t>(i), hits[i]);
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
    struct Sources {
        QuerySource<One> of[RayBatch<One>::most];
    };
    TANDEM_HD static void add(RayBatch<One>& batch, Sources& sources, const TraceJob& job, std::size_t i, bool active) {
        QuerySource<One>& source = sources.of[batch.count];
        source = QuerySource<One>(to_real<One>(job.sources[i]));
        batch.add(to_real<One>(job.rays[i]), source, active);
    }
    template <class Tracer>
    TANDEM_HD static void each(const Tracer& tracer, const TraceJob& job, const RayBatch<One>& batch,
                               std::size_t first) {
        AskNearest<Reals>::each(tracer, job, batch, first);
    }
    template <class Tracer>
    TANDEM_HD static void packet(const Tracer& tracer, const TraceJob& job, const Ray<Packet>& rays, std::size_t first,
                                 std::size_t used, const Mask<Packet>& active) {
        const Source<Packet> source = gather_sources<Packet>(job, first, used);
        AskNearest<Reals>::write(job, first, used, tracer.closest(rays, source, active));
    }
};

/// ... or whether shadow rays are blocked.
template <class Reals>
struct AskOccluded {
    using One = typename Reals::One;
    using Packet = typename Reals::Packet;
    using Sources = typename AskNearestFromSurface<Reals>::Sources;
    TANDEM_HD static void add(RayBatch<One>& batch, Sources& sources, const TraceJob& job, std::size_t i, bool active) {
        ShadowSource<One> shadow;
        if (!job.sources.empty()) static_cast<Source<One>&>(shadow) = to_real<One>(job.sources[i]);
        shadow.light = job.ends[i].light;
        QuerySource<One>& source = sources.of[batch.count];
        source = QuerySource<One>(shadow);
        batch.t_max[batch.count] = constant<Double<One>>(job.ends[i].t);
        batch.add(to_real<One>(job.rays[i]), source, active);
    }
    template <class Tracer>
    TANDEM_HD static void each(const Tracer& tracer, const TraceJob& job, const RayBatch<One>& batch,
                               std::size_t first) {
        bool occluded[RayBatch<One>::most];
        tracer.occluded(batch, occluded);
        for (int i = 0; i < batch.count; ++i) write(job, first + static_cast<std::size_t>(i), occluded[i]);
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
        if (always_packets || (!tracer.view.splits_packets && is_coherent(packet))) {
            Ask::packet(tracer, job, packet, first, used, traceable);
            continue;
        }
        if constexpr (!always_packets) {
            RayBatch<typename Reals::One> batch;
            typename Ask::Sources sources;
            for (std::size_t i = 0; i < used; ++i) {
                Ask::add(batch, sources, job, first + i, traceable[static_cast<int>(i)]);
            }
            Ask::each(tracer, job, batch, first);
        }
    }
    return rejected;
}

template <class Isa, class Reals, class Ask>
std::uint64_t trace_as(const CpuSceneView& view, const TraceJob& job) {
    const CalledTracer<Isa> tracer{view};
    const bool always_packets = view.embree == nullptr && view.groups == nullptr;
    return always_packets ? trace_rays<Reals, Ask, true>(tracer, job) : trace_rays<Reals, Ask, false>(tracer, job);
}

}  // namespace

template <class Isa, Tier tier>
std::uint64_t CpuKernels<Isa, tier>::trace(const CpuSceneView& view, const TraceJob& job) {
    using Reals = TierReals<Isa, tier>;
    if (!job.ends.empty()) return trace_as<Isa, Reals, AskOccluded<Reals>>(view, job);
    if (!job.sources.empty()) return trace_as<Isa, Reals, AskNearestFromSurface<Reals>>(view, job);
    return trace_as<Isa, Reals, AskNearest<Reals>>(view, job);
}

template std::uint64_t CpuKernels<TANDEM_KERNEL_ISA, Tier::TANDEM_KERNEL_TIER>::trace(const CpuSceneView&,
                                                                                      const TraceJob&);

}  // namespace tandem
