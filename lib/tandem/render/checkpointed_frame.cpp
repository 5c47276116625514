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

/// The checkpoint to go on from, or an empty one.
Checkpoint start_of(const ImageMetadata& frame, PlaneMask planes, const CheckpointOptions& options) {
    if (!options.resume || !exists(options.file)) {
        const TileGrid grid{frame.width, frame.height, tile_edge_for(frame.samples)};
        return {frame, {}, TiledFilm(grid, planes)};
    }
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
    constexpr std::size_t most_bytes = std::size_t{15} << 30;  // read_file() reads 16 GiB
    const RenderJob& job = plan.instants.front().job;
    const FilmWindow all = window_of(job);
    if (film_bytes(pixel_count(all), job.planes) > most_bytes) {
        throw InputError(
            fmt::format("a checkpoint of {} x {} pixels with the planes '{}' is larger than 15 GiB; render "
                        "fewer planes or a smaller film",
                        job.width, job.height, to_string(job.planes)));
    }
    check_output(options);
    Checkpoint checkpoint = start_of(frame, job.planes, options);
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

}  // namespace tandem
