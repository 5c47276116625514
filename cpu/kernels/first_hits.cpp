// write_first_hits() of one tier for one instruction set.
#include "tandem/kernel/first_hit.h"

#include "cpu/first_hits.h"
#include "cpu/kernels/called_tracer.h"
#include "cpu/kernels/tier_reals.h"
#include "cpu/tile_pixels.h"

namespace tandem {

template <class Isa, Tier tier>
void write_first_hits(const CpuSceneView& view, const PixelJob& job, const Tile& tile, const FilmPlanes& planes) {
    using Real = typename TierReals<Isa, tier>::Packet;
    using Word = UInt<Real>;
    const CalledTracer<Isa> tracer{view};
    TilePixels<Real> pixels(tile);
    Word x(0U), y(0U);
    while (true) {
        const Mask<Real> used = pixels.next(x, y);
        if (!any(used)) return;
        const FirstHits<Real> hits = find_first_hits<Real>(tracer, view.scene, job, x, y, used);
        const Word at = y * Word(job.width) + x;
        for (int i = 0; i < Real::size; ++i) {
            if (used[i]) keep(hits, i, at[i], planes);
        }
    }
}

template void write_first_hits<TANDEM_KERNEL_ISA, Tier::TANDEM_KERNEL_TIER>(const CpuSceneView&, const PixelJob&,
                                                                            const Tile&, const FilmPlanes&);

}  // namespace tandem
