/// Pixels that the lanes of a packet share, so that its rays visit the same nodes of a hierarchy.
#pragma once

#include <bit>
#include <cstring>

#include "cpu/kernels.h"
#include "cpu/tile_pixels.h"
#include "tandem/kernel/sharing.h"
#include "tandem/math/lanes.h"

namespace tandem {

/// The lanes of a packet: `sharing` neighbours share a pixel, and each of them computes every `sharing`-th of its
/// samples.
template <class Real>
struct SharedLanes {
    std::uint32_t sharing;
    UInt<Real> x{0U}, y{0U}, offset{0U};
    Mask<Real> used{false};

    /// Takes the next pixels; false if there are none.
    TANDEM_HD_INLINE bool take(TilePixels<Real>& pixels) {
        const auto lane = UInt<Real>::from([](int i) { return static_cast<std::uint32_t>(i); });
        UInt<Real> next_x(0U), next_y(0U);
        const Mask<Real> taken = pixels.next(lane < UInt<Real>(Real::size / sharing), next_x, next_y);
        UInt<Real> is_used(0U);
        for (std::uint32_t i = 0; i < Real::size; ++i) {
            const int lane_of_pixel = static_cast<int>(i / sharing), to = static_cast<int>(i);
            if (!taken[lane_of_pixel]) continue;
            set_lane(x, to, next_x[lane_of_pixel]);
            set_lane(y, to, next_y[lane_of_pixel]);
            set_lane(offset, to, i % sharing);
            set_lane(is_used, to, 1U);
        }
        used = is_used != UInt<Real>(0U);
        return any(used);
    }
};

/// Adds to the sum of each pixel the values of its lanes, one after the other.
template <class Wide>
TANDEM_HD_INLINE void add_in_order(const Vec3<Wide>& values, std::uint32_t sharing, Vec3d* sums) {
    double x[Wide::size], y[Wide::size], z[Wide::size];
    static_assert(sizeof(x) == sizeof(values.x));
    std::memcpy(x, &values.x, sizeof(x));
    std::memcpy(y, &values.y, sizeof(y));
    std::memcpy(z, &values.z, sizeof(z));
    for (std::uint32_t first = 0; first < Wide::size; first += sharing) {
        Vec3d sum = *sums;
        for (std::uint32_t i = first; i < first + sharing; ++i) sum = sum + Vec3d{x[i], y[i], z[i]};
        *sums++ = sum;
    }
}

/// Paths of one vertex. The lanes of a pixel follow the paths of as many samples at a time; their radiances are added
/// in the order of the samples, which gives the bits of one lane per pixel.
template <class Effects, class Real, class Tracer>
TANDEM_HD TileStats render_shared_pixels(const Tracer& tracer, const SceneView& scene, const PixelJob& job,
                                         const Tile& tile, Vec3d* sums) {
    using Word = UInt<Real>;
    constexpr std::uint32_t size = Real::size;
    const Wide<Real> zero(0.0);
    TileStats stats;
    TilePixels<Real> pixels(tile);
    SharedLanes<Real> lanes{sharing_of(job.samples, size)};
    PathTally<Real> tally;
    while (lanes.take(pixels)) {
        SampleId<Real> id = sample_of<Real>(job, lanes.x, lanes.y, Word(job.first_sample));
        const PixelRays<Real> rays = rays_of_pixel<Real>(job, lanes.x, lanes.y);
        Vec3d sum[size] = {};
        for (std::uint32_t first = 0; first < job.samples; first += lanes.sharing) {
            const Word number = Word(first) + lanes.offset;
            const Mask<Real> active = lanes.used && number < Word(job.samples);
            id.sample = Word(job.first_sample) + number;
            const Vec3<Real> radiance =
                sample_radiance<Effects>(tracer, scene, job, rays, id, active, IndependentThreads(), tally);
            const Addend<Real> addend = addend_of(radiance);
            stats.counters.invalid_samples +=
                static_cast<std::uint64_t>(std::popcount((active && !addend.is_number).bits()));
            add_in_order(select(active, to_wide(addend.radiance), Vec3<Wide<Real>>{zero, zero, zero}), lanes.sharing,
                         sum);
        }
        for (std::uint32_t i = 0; i < size; i += lanes.sharing) {
            const int lane = static_cast<int>(i);
            if (lanes.used[lane]) sums[lanes.y[lane] * job.width + lanes.x[lane]] = sum[i / lanes.sharing];
        }
    }
    stats.add(tally);
    return stats;
}

}  // namespace tandem
