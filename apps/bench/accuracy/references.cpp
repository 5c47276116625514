#include "accuracy/references.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "accuracy/settings.h"
#include "frame_timing.h"
#include "output.h"
#include "tandem/base/error.h"
#include "tandem/images/image_io.h"
#include "tandem/render/frame_metadata.h"
#include "tandem/render/motion_blur.h"
#include "tandem/render/pixel_filter_names.h"

namespace tandem::bench {

namespace {

/// Far from the seeds of a report, which count upwards.
std::uint64_t seed_of(const ReferenceOptions& options, char which) {
    return options.seed ^ (which == 'a' ? 0x9E3779B97F4A7C15U : 0xC2B2AE3D27D4EB4FU);
}

RenderJob job_of(const ReferenceOptions& options, char which) {
    RenderJob job;
    job.width = options.size.width;
    job.height = options.size.height;
    job.samples = options.samples;
    job.seed = seed_of(options, which);
    job.tier = Tier::precise;
    job.limits = unlimited;
    job.sampler = Sampler::sobol;  // less noise than independent samples (docs/reading-results.md)
    job.filter = options.filter;
    return job;
}

ImageMetadata metadata_of(const AccuracyScene& scene, const Backend& backend, const RenderJob& job) {
    return describe(job, frame_hash(scene.scene, plan_frame(scene.scene, {}, job)), backend.name());
}

/// How a stored reference differs from the wanted one; empty if it does not.
std::string mismatch(const std::optional<ImageMetadata>& stored, ImageMetadata wanted) {
    if (!stored) return "the image has no metadata written by Tandem";
    wanted.version = stored->version;  // it approximates the same truth
    return difference_of_films(*stored, wanted);
}

FloatImage read_reference(const std::string& path, const ImageMetadata& wanted) {
    DecodedImage stored = read_image(path);
    const std::string problem = mismatch(stored.metadata, wanted);
    if (!problem.empty()) {
        throw InputError(
            fmt::format("the reference {} does not match: {}; render it again with --rebuild-references, or "
                        "name another folder",
                        path, problem));
    }
    return std::move(stored.image);
}

void make_folder(const std::string& folder) {
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    if (problem) {
        throw InputError(fmt::format("cannot make the folder {} for references: {}", folder, problem.message()));
    }
}

FloatImage image_of(const AccuracyScene& scene, Backend& backend, const ReferenceOptions& options, char which) {
    const RenderJob job = job_of(options, which);
    const std::string path = reference_path(scene, options, which);
    if (!path.empty() && !options.rebuild && std::filesystem::exists(path)) {
        return read_reference(path, metadata_of(scene, backend, job));
    }
    log_progress(fmt::format("{}: reference {} of {} with {} samples per pixel on {}", scene.name, which,
                             to_string(options.filter), options.samples, backend.name()));
    TimedFrame frame = render_timed(backend, scene.scene, job);
    FloatImage image = film_to_image(frame.film);
    if (!path.empty()) {
        make_folder(options.folder);
        ImageMetadata metadata = metadata_of(scene, backend, job);
        metadata.film_sha256 = film_hash(frame.film);
        write_image(path, image, metadata, {.durability = Durability::written});
    }
    return image;
}

}  // namespace

std::string reference_path(const AccuracyScene& scene, const ReferenceOptions& options, char which) {
    if (options.folder.empty()) return {};
    std::string name;
    for (const char c : scene.name) {
        const bool plain =
            (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '.';
        name += plain ? c : '_';
    }
    const std::string filter = options.filter == PixelFilter::box ? "" : to_string(options.filter) + "-";
    return fmt::format("{}/{}-{}x{}-{}{}.pfm", options.folder, name, options.size.width, options.size.height, filter,
                       which);
}

DescribedReference make_reference(const AccuracyScene& scene, Backend& backend, const ReferenceOptions& options) {
    if (scene.truth) {
        FloatImage truth{options.size.width, options.size.height, {}};
        truth.pixels.assign(pixel_count(truth), *scene.truth);
        return {Reference(std::move(truth)), fmt::format("The reference is a closed form: {}.", scene.closed_form)};
    }
    FloatImage a = image_of(scene, backend, options, 'a');
    FloatImage b = image_of(scene, backend, options, 'b');
    const std::string filter =
        options.filter == PixelFilter::box ? "" : fmt::format(" with the filter {}", to_string(options.filter));
    const std::string place = options.folder.empty() ? "" : fmt::format(", kept in {}", options.folder);
    return {Reference(std::move(a), std::move(b)),
            fmt::format(
                "The references{} are two images in the tier precise, with {} samples of the sampler sobol per pixel "
                "each, the seeds {} and {}, and paths of up to 255 vertices of each kind{}.",
                filter, options.samples, seed_of(options, 'a'), seed_of(options, 'b'), place)};
}

}  // namespace tandem::bench
