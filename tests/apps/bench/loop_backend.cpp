#include "loop_backend.h"

#include "tandem/base/seconds.h"
#include "tandem/kernel/traversal/intersect.h"
#include "tandem/render/pixel_job.h"
#include "tandem/render/ready_frame.h"

namespace tandem::bench {

double LoopBackend::trace(ResidentScene& scene, const TraceJob& job) {
    const Stopwatch watch;
    const LoopTracer tracer{view(dynamic_cast<LoopScene&>(scene).prepared)};
    for (std::size_t i = 0; i < job.rays.size(); ++i) {
        const Closest<float> closest = tracer.closest(job.rays[i], NoSource{}, true);
        job.hits[i] = to_hit(closest);
        if (job.wide_t.empty()) continue;
        job.wide_t[i] = (closest.primitive == no_primitive ? 0 : closest.t) + (spoiled_ ? 1 : 0);
    }
    if (spoiled_) job.hits[0].t += 1;
    return watch.seconds();
}

std::unique_ptr<PendingFrame> LoopBackend::submit(std::shared_ptr<ResidentScene> scene, const RenderJob& job) {
    const Stopwatch watch;
    const PreparedScene& prepared = dynamic_cast<LoopScene&>(*scene).prepared;
    const SceneView window = view(prepared);
    const PixelJob pixel_job = make_pixel_job(prepared.camera, job);
    const FilmWindow part = window_of(job);
    RenderResult result{Film(part.width, part.height, job.samples), {}};
    for (std::uint32_t i = 0; i < result.film.pixel_count(); ++i) {
        result.film.sums()[i] = render_pixel<EffectSet<0>, float>(LoopTracer{window}, window, pixel_job,
                                                                  i % pixel_job.width, i / pixel_job.width, true)
                                    .sum;
    }
    if (spoiled_) result.film.sums()[0].x += 1e-12;
    result.stats.seconds.render = watch.seconds();
    result.stats.variant = "loop";
    return std::make_unique<ReadyFrame>(std::move(result));
}

}  // namespace tandem::bench
