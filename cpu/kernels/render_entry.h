/// The path loop, included by the files of its variants.
#pragma once

#include "cpu/kernels/called_tracer.h"
#include "cpu/kernels/tier_reals.h"
#include "cpu/path_sorter.h"
#include "cpu/shared_pixels.h"
#include "cpu/tile_pixels.h"

namespace tandem {

/// Paths of one vertex among few solids without a hierarchy: one pixel per lane.
template <class Effects, class Real, class Tracer>
TANDEM_HD TileStats render_pixels(const Tracer& tracer, const SceneView& scene, const PixelJob& job, const Tile& tile,
                                  Vec3d* sums) {
    using Word = UInt<Real>;
    TileStats stats;
    TilePixels<Real> pixels(tile);
    Word x(0U), y(0U);
    while (true) {
        const Mask<Real> used = pixels.next(x, y);
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

/// Longer paths: a lane that is finished takes the next sample of the tile.
template <class Effects, class Real, class Tracer>
TANDEM_HD TileStats follow_paths(const Tracer& tracer, const SceneView& scene, const PixelJob& job, const Tile& tile,
                                 Vec3d* sums) {
    TileStats stats;
    SampleSets<Real> samples(job, tile, sums);
    PathSorter<Effects, Real> pool;
    do {
        samples.add_sets();
        pool.take(samples);
    } while (pool.step(tracer, scene, job, samples, stats));
    return stats;
}

template <class Isa, Tier tier>
template <std::size_t variant>
TileStats CpuKernels<Isa, tier>::render_tile(const CpuSceneView& view, const PixelJob& job, const Tile& tile,
                                             Vec3d* sums) {
    using Effects = EffectSet<variants[variant].effects.bits()>;
    using Real = typename TierReals<Isa, tier>::Packet;
    const CalledTracer<Isa> tracer{view};
    if constexpr (can_bounce<Effects>()) {
        return follow_paths<Effects, Real>(tracer, view.scene, job, tile, sums);
    } else {
        if (can_leave_surfaces<Effects>() || view.embree != nullptr) {
            return render_shared_pixels<Effects, Real>(tracer, view.scene, job, tile, sums);
        }
        return render_pixels<Effects, Real>(LoopTracer{view.scene}, view.scene, job, tile, sums);
    }
}

}  // namespace tandem
