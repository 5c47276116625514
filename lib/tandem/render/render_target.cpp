#include "tandem/render/render_target.h"

#include <fmt/format.h>

#include <cmath>

#include "tandem/base/error.h"
#include "tandem/render/allotment.h"
#include "tandem/render/sampler_names.h"

namespace tandem {

void check(const RenderTarget& target, const RenderJob& job) {
    if (!(target.error >= 0) || !std::isfinite(target.error)) {
        throw InputError(fmt::format("the target of the error is {}, but must be a number above 0", target.error));
    }
    if (!(target.seconds > 0)) {
        throw InputError(fmt::format("the time budget is {} s, but must be above 0", target.seconds));
    }
    const bool is_set = target.error > 0 || std::isfinite(target.seconds);
    if (job.samples < 2 && is_set) {
        throw InputError("one sample per pixel has no variance; allow 2 or more (--spp) for a target of error or time");
    }
    if (target.metric == ErrorMetric::flip && job.samples < first_round_end) {
        throw InputError(
            fmt::format("FLIP is estimated from {} samples per pixel or more; raise --spp", first_round_end));
    }
    if (job.sampler != Sampler::random && is_set) {
        throw InputError(
            fmt::format("a target of error or time estimates errors from independent samples, but those of the sampler "
                        "'{}' are not independent; use --sampler random",
                        to_string(job.sampler)));
    }
    if (job.window) throw InputError("a target of error or time needs the whole film, not a window");
}

std::string error_text(const RenderTarget& target) {
    return target.error > 0 ? fmt::format("{} {}", to_string(target.metric), target.error) : "time";
}

std::string to_string(const RenderTarget& target) {
    std::string text;
    if (target.error > 0) text = error_text(target);
    if (std::isfinite(target.seconds)) text += fmt::format("{}within {} s", text.empty() ? "" : " ", target.seconds);
    return text;
}

}  // namespace tandem
