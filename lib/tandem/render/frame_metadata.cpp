#include "tandem/render/frame_metadata.h"

#include <fmt/format.h>

#include <utility>

#include "tandem/base/version.h"
#include "tandem/film/plane_names.h"
#include "tandem/render/pixel_filter_names.h"
#include "tandem/render/sampler_names.h"

namespace tandem {

ImageMetadata describe(const RenderJob& job, std::string scene_hash, std::string backend) {
    ImageMetadata metadata;
    metadata.scene_hash = std::move(scene_hash);
    metadata.frame = job.frame;
    metadata.width = job.width;
    metadata.height = job.height;
    metadata.samples = job.samples;
    metadata.seed = job.seed;
    metadata.limits = to_string(job.limits);
    metadata.sampler = to_string(job.sampler);
    metadata.filter = to_string(job.filter);
    metadata.tier = to_string(job.tier);
    metadata.backend = std::move(backend);
    metadata.version = version();
    metadata.planes = to_string(job.planes);
    return metadata;
}

RenderJob job_of(const ImageMetadata& metadata) {
    RenderJob job;
    job.width = metadata.width;
    job.height = metadata.height;
    job.samples = metadata.samples;
    job.seed = metadata.seed;
    job.frame = metadata.frame;
    job.tier = parse_tier(metadata.tier);
    job.limits = parse_limits(metadata.limits);
    if (!metadata.sampler.empty()) job.sampler = parse_sampler(metadata.sampler);
    if (!metadata.filter.empty()) job.filter = parse_pixel_filter(metadata.filter);
    job.window = FilmWindow{0, 0, 1, 1};  // a film may be larger than what is rendered of it at once
    check(job);
    job.window.reset();
    return job;
}

std::string difference_of_films(const ImageMetadata& there, const ImageMetadata& here) {
    std::string text;
    const auto compare = [&](const char* name, const auto& a, const auto& b) {
        if (a != b) text += fmt::format("{}{} is '{}' there, but '{}' here", text.empty() ? "" : "; ", name, a, b);
    };
    compare("version", there.version, here.version);
    compare("frame", there.frame, here.frame);
    compare("width", there.width, here.width);
    compare("height", there.height, here.height);
    compare("samples", there.samples, here.samples);
    compare("seed", there.seed, here.seed);
    compare("limits", there.limits, here.limits);
    compare("sampler", there.sampler, here.sampler);
    compare("filter", there.filter, here.filter);
    compare("tier", there.tier, here.tier);
    compare("planes", there.planes, here.planes);
    compare("target", there.target, here.target);
    compare("scene_hash", there.scene_hash, here.scene_hash);
    return text;
}

}  // namespace tandem
