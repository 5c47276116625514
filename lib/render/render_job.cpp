#include "tandem/render/render_job.h"

#include <fmt/format.h>

#include <charconv>

#include "tandem/error/error.h"

namespace tandem {

std::string to_string(const PathLimits& limits) { return fmt::format("{},{}", limits.reflection, limits.refraction); }

PathLimits parse_limits(const std::string& text) {
    PathLimits limits;
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, limits.reflection);
    if (first.ec == std::errc() && first.ptr != end && *first.ptr == ',') {
        const auto second = std::from_chars(first.ptr + 1, end, limits.refraction);
        if (second.ec == std::errc() && second.ptr == end) return limits;
    }
    throw InputError(
        fmt::format("the limits of a path are two whole numbers, as in 8,16: how many reflections, how "
                    "many refractions; '{}' is not",
                    text));
}

void check(const RenderJob& job) {
    const auto in_range = [](const char* field, int value, int most) {
        if (value < 1 || value > most) {
            throw InputError(fmt::format("{} is {}, but must be from 1 to {}", field, value, most));
        }
    };
    in_range("width", job.width, 65536);
    in_range("height", job.height, 65536);
    in_range("samples per pixel", job.samples, 1 << 24);
    for (const auto& [kind, limit] :
         {std::pair{"reflections", job.limits.reflection}, std::pair{"refractions", job.limits.refraction}}) {
        if (limit > 255) throw InputError(fmt::format("the limit of {} is {}, but must be from 0 to 255", kind, limit));
    }
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
