/// Frames rendered until they reach an error, with more samples where the noise is stronger.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "tandem/film/error_estimate.h"
#include "tandem/render/allotment.h"
#include "tandem/render/motion_blur.h"
#include "tandem/render/render_target.h"
#include "tandem/render/round_state.h"

namespace tandem {

enum class StoppedBy { target, samples, time, interrupt };
[[nodiscard]] const char* to_string(StoppedBy reason);

struct TargetFrame {
    RenderedFrame frame;  ///< its film has the planes of the job
    StatedError error;
    StoppedBy stopped_by = StoppedBy::samples;
    std::string tile_samples;  ///< tile_samples_text()
    double mean_samples = 0;   ///< per pixel
};

/// A render that can be saved between two windows of its film, and resumed later.
struct Resumption {
    std::optional<RoundState> begin;  ///< where to resume
    RenderCounters counters{};        ///< of what is in `begin`
    /// Called now and then, and before an interrupted render returns, unless it is empty.
    std::function<void(const RoundState&, const RenderCounters&)> save{};
    double every = 60;  ///< seconds from one call to the next
};

/// Renders square tiles of target_tile_edge() pixels in rounds, which allot() decides. After each round it knows the
/// errors of all tiles from all samples so far, and decides the next round by them. The samples of a last round have
/// not decided that it is the last. So the reported error is estimated from these samples alone or, if the first such
/// round did not end the render, from all samples since that round began. (Two-stage sampling: C. Stein, "A two-sample
/// test for a linear hypothesis whose power is independent of the variance", Annals of Mathematical Statistics, 1945.)
/// If that error, at the lower end of its interval, is above the target, rounds go on. The interval also contains that
/// of the error estimated from all samples. Some of these have decided something, but they are more: they show what the
/// film itself has caught. (Not for flip, which is always estimated from all.)
///
/// Decisions depend on the film alone, so in the exact tiers every backend renders the same bits. The time limit is the
/// exception: a round does not start if, by the time of the rounds before, it would end too late; the first always
/// does. Once `interrupted` is set, no window of the film starts; nothing is returned if a tile has no samples, or if
/// the render was saved. `clock`: seconds.
///
/// Throws InputError for a frame with motion blur, whose samples are not independent.
[[nodiscard]] std::optional<TargetFrame> render_to_target(Backend& backend, const Scene& scene, const FramePlan& plan,
                                                          const RenderTarget& target,
                                                          const std::atomic<bool>& interrupted,
                                                          const std::function<double()>& clock,
                                                          const Resumption& resumption = {});

/// 32 pixels, or 16 or 8 for films that would have fewer than 64 tiles.
[[nodiscard]] int target_tile_edge(int width, int height);

/// The errors of the tiles of a film, with all its samples, from the samples of `fresh` alone; from all samples if it
/// is null and the metric is not flip. `fresh`: some of the samples of each tile.
[[nodiscard]] std::vector<TileErrors> tile_errors(const TiledFilm& film, const std::vector<Film>* fresh,
                                                  const RenderTarget& target);

/// The sum over tiles.
[[nodiscard]] ErrorSums sum_of(const std::vector<TileErrors>& tiles);

/// Throws InputError that says what to do if the plan has motion blur.
void check_still(const FramePlan& plan);

}  // namespace tandem
