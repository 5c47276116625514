#include "tandem/render/checkpointed_frame.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "tandem/base/error.h"
#include "tandem/base/seconds.h"
#include "tandem/base/whole_file.h"
#include "tandem/film/plane_names.h"
#include "tandem/render/checkpoint.h"
#include "tandem/render/frame_metadata.h"
#include "tandem/render/tiled_frame.h"

namespace tandem {

namespace {

bool exists(const std::string& path) {
    std::error_code ignored;
    return std::filesystem::exists(path, ignored);
}

/// The checkpoint to go on from, if there is one.
std::optional<Checkpoint> start_of(const ImageMetadata& frame, const CheckpointOptions& options) {
    if (!options.resume || !exists(options.file)) return std::nullopt;
    Checkpoint checkpoint = read_checkpoint(options.file);
    const std::string difference = difference_of_films(checkpoint.frame, frame);
    if (!difference.empty()) {
        throw InputError(
            fmt::format("the checkpoint '{}' is of another render: {}. Resume with the scene, the options and the "
                        "version that it was begun with, or name another file",
                        options.file, difference));
    }
    return checkpoint;
}

/// `per_pixel`: bytes, of all films in the checkpoint.
void check_size(const RenderJob& job, std::size_t per_pixel) {
    constexpr std::size_t most_bytes = std::size_t{15} << 30;  // read_file() reads 16 GiB
    if (pixel_count(window_of(job)) <= most_bytes / per_pixel) return;
    throw InputError(
        fmt::format("a checkpoint of {} x {} pixels with the planes '{}' is larger than 15 GiB; render fewer planes or "
                    "a smaller film",
                    job.width, job.height, to_string(job.planes)));
}

}  // namespace

void check_output(const CheckpointOptions& options) {
    check_can_write(options.file);
    if (!options.resume && exists(options.file)) {
        throw InputError(
            fmt::format("'{0}' exists: go on from it with --resume, or remove it to begin again", options.file));
    }
}

std::optional<RenderedFrame> render_with_checkpoints(Backend& backend, const Scene& scene, const FramePlan& plan,
                                                     const ImageMetadata& frame, const CheckpointOptions& options,
                                                     const std::atomic<bool>& interrupted) {
    const RenderJob& job = plan.instants.front().job;
    check_size(job, film_bytes(1, job.planes));
    check_output(options);
    const TileGrid grid{frame.width, frame.height, tile_edge_for(frame.samples)};
    Checkpoint checkpoint = start_of(frame, options).value_or(Checkpoint{frame, {}, TiledFilm(grid, job.planes)});
    TileCosts costs;
    costs.stats.counters = checkpoint.counters;
    Stopwatch since_last;
    const auto save = [&] {
        checkpoint.counters = costs.stats.counters;
        write_checkpoint(options.file, checkpoint);
        since_last = Stopwatch();
    };
    const auto after_tile = [&] {
        if (interrupted) return false;
        if (since_last.seconds() >= options.every) save();
        return true;
    };
    const bool is_complete = render_tiles(backend, scene, plan, checkpoint.film, costs, after_tile);
    if (!is_complete || interrupted) {
        save();
        if (!is_complete) return std::nullopt;
    }
    return RenderedFrame{{checkpoint.film.whole(), std::move(costs.stats)}, costs.load, costs.prepare};
}

std::optional<TargetFrame> render_to_target_with_checkpoints(Backend& backend, const Scene& scene,
                                                             const FramePlan& plan, const RenderTarget& target,
                                                             ImageMetadata frame, const CheckpointOptions& options,
                                                             const std::atomic<bool>& interrupted,
                                                             const std::function<double()>& clock) {
    const RenderJob& job = plan.instants.front().job;
    const PlaneMask planes = job.planes | FilmPlane::variance;
    check_size(job, film_bytes(1, planes) + film_bytes(1, FilmPlane::variance));
    check_output(options);
    frame.planes = to_string(planes);
    frame.target = error_text(target);
    if (target.metric == ErrorMetric::flip) frame.target += " as " + in_words(target.display);
    Resumption resumption;
    if (std::optional<Checkpoint> start = start_of(frame, options)) {
        if (!start->round) {
            throw InputError(
                fmt::format("the checkpoint '{}' has no round of samples; remove it and begin again", options.file));
        }
        resumption.begin = RoundState{std::move(start->film), *std::move(start->round)};
        resumption.counters = start->counters;
    }
    resumption.every = options.every;
    resumption.save = [&](const RoundState& state, const RenderCounters& counters) {
        write_checkpoint(options.file, {frame, counters, state.film, state.round});
    };
    return render_to_target(backend, scene, plan, target, interrupted, clock, resumption);
}

}  // namespace tandem
