/// The kernels of the exact tiers for one instruction set. Included by kernels_v2.cpp, kernels_v3.cpp and
/// kernels_v4.cpp, each compiled for its own.
#pragma once

#include "cpu/embree_tracer.h"
#include "cpu/kernels.h"
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

/// One pixel per lane, along rows.
template <class Reals, class Tracer>
std::uint64_t render_pixels(const Tracer& tracer, const SceneView& scene, const PixelJob& job, const Tile& tile,
                            Vec3d* sums) {
    using Real = typename Reals::Packet;
    using Word = UInt<Real>;
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

template <class Reals>
std::uint64_t render_tile(const CpuSceneView& view, const PixelJob& job, const Tile& tile, Vec3d* sums) {
    if (view.embree != nullptr) return render_pixels<Reals>(EmbreeTracer{view}, view.scene, job, tile, sums);
    return render_pixels<Reals>(LoopTracer{view.scene}, view.scene, job, tile, sums);
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

template <class Reals, class Tracer>
void trace_rays(const Tracer& tracer, bool always_packets, const TraceJob& job) {
    using One = typename Reals::One;
    using Packet = typename Reals::Packet;
    using Scalar = typename RealTraits<Packet>::Scalar;
    constexpr std::size_t width = Packet::size;
    const std::size_t count = job.rays.size();
    const Ray<float>* rays = job.rays.data();
    const auto write = [&](std::size_t i, const Closest<One>& closest) {
        job.hits[i] = to_hit(closest);
        if (!job.wide_t.empty()) job.wide_t[i] = closest.primitive == no_primitive ? 0 : to_wide(closest.t);
    };
    for (std::size_t first = 0; first < count; first += width) {
        const std::size_t used = count - first < width ? count - first : width;
        const auto load = [&](auto component) {
            return Packet::from([&](int lane) {
                const std::size_t i = static_cast<std::size_t>(lane) < used ? static_cast<std::size_t>(lane) : 0;
                return static_cast<Scalar>(component(rays[first + i]));
            });
        };
        const Ray<Packet> packet = {
            {load([](const Ray<float>& r) { return r.origin.x; }), load([](const Ray<float>& r) { return r.origin.y; }),
             load([](const Ray<float>& r) { return r.origin.z; })},
            {load([](const Ray<float>& r) { return r.direction.x; }),
             load([](const Ray<float>& r) { return r.direction.y; }),
             load([](const Ray<float>& r) { return r.direction.z; })}};
        if (always_packets || is_coherent(packet)) {
            const Closest<Packet> closest = tracer.closest(packet, is_traceable(packet));
            for (std::size_t i = 0; i < used; ++i) {
                const int lane = static_cast<int>(i);
                write(first + i, {closest.t[lane], closest.primitive[lane]});
            }
        } else {
            for (std::size_t i = first; i < first + used; ++i) {
                const bool traceable = is_traceable(rays[i]);
                write(i, traceable ? tracer.closest(to_real<One>(rays[i]), true) : no_hit<One>());
            }
        }
    }
}

template <class Reals>
void trace(const CpuSceneView& view, const TraceJob& job) {
    if (view.embree != nullptr) return trace_rays<Reals>(EmbreeTracer{view}, false, job);
    trace_rays<Reals>(LoopTracer{view.scene}, true, job);
}

template <class Reals>
inline constexpr TierKernels tier_kernels = {render_tile<Reals>, trace<Reals>,
                                             intersect_callback<typename Reals::One, typename Reals::Packet>};

}  // namespace tandem
