#include "render/plan_command.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "common/run_main.h"
#include "tandem/base/seconds.h"
#include "tandem/render/forecast.h"

namespace tandem {

namespace {

void print(const std::string& sentence) { std::printf("plan: %s\n", sentence.c_str()); }

const char* word_for(Fits fits) { return fits == Fits::no ? "cannot" : fits == Fits::yes ? "fits" : "may not fit"; }

}  // namespace

int run_plan(const RenderCommand& command, const Scene& scene, Backend& backend) {
    const SequenceOptions& options = command.sequence;
    RenderJob job = options.job;
    job.frame = static_cast<std::uint32_t>(options.frames.first);
    const FramePlan plan =
        plan_frame(scene, {.frame = options.frames.first, .camera = options.camera, .effects = options.effects}, job);
    RenderTarget target = options.target.value_or(RenderTarget{});
    target.display = display_of(options, scene);
    const Stopwatch watch;
    const Forecast expected = forecast(backend, scene, plan, target, [&watch] { return watch.seconds(); });
    print(fmt::format(
        "frame {}: {:.4g} samples per pixel on average ({:.4g} to {:.4g}) and {:.3g} s ({:.3g} to {:.3g}) with {}, "
        "from a "
        "probe of {:.2g} s",
        job.frame, expected.samples.value, expected.samples.low, expected.samples.high, expected.seconds.value,
        expected.seconds.low, expected.seconds.high, backend.name(), expected.probe_seconds));
    bool can = true;
    if (!expected.can_reach) {
        print(
            fmt::format("cannot reach {} with {} samples per pixel, but about {:.3g} ({:.3g} to {:.3g}); raise --spp "
                        "or --target-error",
                        error_text(target), job.samples, expected.least_error.value, expected.least_error.low,
                        expected.least_error.high));
        can = false;
    }
    if (std::isfinite(target.seconds)) {
        const Fits verdict = fits(expected, target.seconds);
        print(fmt::format("{} within {} s", word_for(verdict), target.seconds));
        can = can && verdict != Fits::no;
    }
    return can ? exit_done : exit_short_of_target;
}

}  // namespace tandem
