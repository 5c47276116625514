#include "tandem/render/render_job.h"

#include <fmt/format.h>

#include "tandem/error/error.h"

namespace tandem {

void check(const RenderJob& job) {
    const auto in_range = [](const char* field, int value, int most) {
        if (value < 1 || value > most) {
            throw InputError(fmt::format("{} is {}, but must be from 1 to {}", field, value, most));
        }
    };
    in_range("width", job.width, 65536);
    in_range("height", job.height, 65536);
    in_range("samples per pixel", job.samples, 1 << 24);
    const auto pixels = static_cast<std::uint64_t>(job.width) * static_cast<std::uint64_t>(job.height);
    if (pixels > std::uint64_t{1} << 30) {
        throw InputError(
            fmt::format("a film of {} x {} has over 2^30 pixels; render it in parts", job.width, job.height));
    }
}

void check(const RenderJob& job, Tier loaded_for) {
    check(job);
    if (job.tier != loaded_for) {
        throw InputError(
            fmt::format("the job asks for the tier '{0}', but its scene was loaded for '{1}'; load it for '{0}'",
                        to_string(job.tier), to_string(loaded_for)));
    }
}

}  // namespace tandem
