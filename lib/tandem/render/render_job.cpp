#include "tandem/render/render_job.h"

#include <fmt/format.h>

#include <charconv>
#include <utility>

#include "tandem/base/error.h"
#include "tandem/render/sampler_names.h"

namespace tandem {

std::string to_string(const PathLimits& limits) {
    return fmt::format("{},{},{}", limits.reflection, limits.refraction, limits.diffuse);
}

PathLimits parse_limits(const std::string& text) {
    PathLimits limits;
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::uint32_t* limit : {&limits.reflection, &limits.refraction, &limits.diffuse}) {
        const auto [stop, error] = std::from_chars(at, end, *limit);
        const bool is_last = limit == &limits.diffuse;
        if (error != std::errc() || (is_last ? stop != end : stop == end || *stop != ',')) {
            throw InputError(
                fmt::format("the limits of a path are three whole numbers, as in 8,16,4: the "
                            "reflections, refractions and diffuse bounces; '{}' is something else",
                            text));
        }
        at = stop + 1;
    }
    return limits;
}

FilmWindow window_of(const RenderJob& job) { return job.window.value_or(FilmWindow{0, 0, job.width, job.height}); }

void check(const RenderJob& job) {
    const auto in_range = [](const char* field, int value, int most) {
        if (value < 1 || value > most) {
            throw InputError(fmt::format("{} is {}, but must be from 1 to {}", field, value, most));
        }
    };
    in_range("width", job.width, 65536);
    in_range("height", job.height, 65536);
    in_range("samples per pixel", job.samples, 1 << 24);
    if (job.first_sample < 0 || job.first_sample > (1 << 24) - job.samples) {
        throw InputError(
            fmt::format("the first sample is {}, but must be from 0 to {}, which is 2^24 minus the samples",
                        job.first_sample, (1 << 24) - job.samples));
    }
    for (const auto& [kind, limit] :
         {std::pair{"reflections", job.limits.reflection}, std::pair{"refractions", job.limits.refraction},
          std::pair{"scatterings", job.limits.diffuse}}) {
        if (limit > 255) throw InputError(fmt::format("the limit of {} is {}, but must be from 0 to 255", kind, limit));
    }
    if (job.sampler != Sampler::random && job.planes.has(FilmPlane::variance)) {
        throw InputError(
            fmt::format("the plane 'variance' takes samples to be independent, but those of the sampler '{}' are not; "
                        "use the sampler 'random', or name the planes without it",
                        to_string(job.sampler)));
    }
    const FilmWindow window = window_of(job);
    const auto fits = [](int first, int size, int limit) { return first >= 0 && size >= 1 && size <= limit - first; };
    if (!fits(window.left, window.width, job.width) || !fits(window.top, window.height, job.height)) {
        throw InputError(
            fmt::format("the window of {} x {} pixels at ({}, {}) must have pixels, and lie within the film of {} x {}",
                        window.width, window.height, window.left, window.top, job.width, job.height));
    }
    const auto pixels = static_cast<std::uint64_t>(window.width) * static_cast<std::uint64_t>(window.height);
    if (pixels > std::uint64_t{1} << 30) {
        throw InputError(fmt::format("a film of {} x {} has more than 2^30 pixels; render windows of it", window.width,
                                     window.height));
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
