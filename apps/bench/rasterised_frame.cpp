#include "rasterised_frame.h"

#include "baseline/rasteriser.h"
#include "tandem/base/seconds.h"
#include "tandem/compile/prepare.h"
#include "tandem/compile/prepared_scene.h"

namespace tandem::bench {

TimedFrame rasterise_timed(const Scene& scene, const RenderJob& job, int threads) {
    TimedFrame timed;
    const Stopwatch everything;
    const PreparedScene prepared = prepare(scene, {.frame = static_cast<std::int32_t>(job.frame)});
    timed.prepare = everything.seconds();
    const Stopwatch build;
    const RasterScene triangles = make_raster_scene(prepared, job.width, job.height);
    timed.load.build = build.seconds();
    const Stopwatch render;
    timed.film = rasterise(triangles, {job.width, job.height, job.samples, job.seed, threads});
    timed.stats.seconds.render = timed.frame = render.seconds();
    timed.everything = everything.seconds();
    timed.stats.variant = "z-buffer";
    timed.stats.effects = prepared.effects & rasterised_effects;
    return timed;
}

}  // namespace tandem::bench
