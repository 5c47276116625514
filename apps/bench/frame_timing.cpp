#include "frame_timing.h"

#include "tandem/base/seconds.h"
#include "tandem/compile/prepared_scene.h"
#include "tandem/render/motion_blur.h"

namespace tandem::bench {

TimedFrame render_timed(Backend& backend, const Scene& scene, const RenderJob& job, const ForcedEffects& effects) {
    TimedFrame timed;
    const Stopwatch everything;
    const FramePlan plan = plan_frame(scene, {.frame = static_cast<std::int32_t>(job.frame), .effects = effects}, job);
    if (is_blurred(plan)) {
        RenderedFrame frame = render_frame(backend, scene, plan);
        timed.everything = timed.frame = everything.seconds();
        timed.prepare = frame.prepare;
        timed.load = frame.load;
        timed.film = std::move(frame.result.film);
        timed.stats = std::move(frame.result.stats);
        return timed;
    }
    const PreparedScene prepared = prepare(scene, plan.instants.front().prepare);
    timed.prepare = everything.seconds();
    const std::shared_ptr<ResidentScene> resident = backend.load(prepared, job.tier);
    const Stopwatch frame;
    RenderResult result = backend.render(resident, job);
    timed.frame = frame.seconds();
    timed.everything = everything.seconds();
    timed.load = resident->load_times();
    timed.film = std::move(result.film);
    timed.stats = std::move(result.stats);
    return timed;
}

void record(BenchmarkRow& row, std::int32_t round, double seconds, const TimedFrame& timed) {
    row.seconds.push_back(seconds);
    row.rounds.push_back(round);
    row.variant = timed.stats.variant;
    row.effects = timed.stats.effects;
    row.carried = timed.stats.carried;
    row.registers = timed.stats.registers;
    row.occupancy = timed.stats.occupancy;
    row.rays = static_cast<double>(timed.stats.rays);
    row.counters += timed.stats.counters;
    const auto add = [&](const char* name, double value) { phase(row, name).seconds.push_back(value); };
    add("prepare", timed.prepare);
    add("build", timed.load.build);
    add("compile", timed.stats.seconds.compile);
    add("upload", timed.load.upload);
    add("render", timed.stats.seconds.render);
    add("download", timed.stats.seconds.download);
    add("frame", timed.frame);
}

double sample_count(const RenderJob& job) {
    return static_cast<double>(job.width) * static_cast<double>(job.height) * static_cast<double>(job.samples);
}

}  // namespace tandem::bench
