/// Frames rendered until they reach an error, with more samples where the noise is stronger.
#pragma once

#include <atomic>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "tandem/film/error_estimate.h"
#include "tandem/render/motion_blur.h"

namespace tandem {

struct RenderTarget {
    double error = 0;  ///< in the unit of the metric; 0: none, so that time or the samples of the job end it
    ErrorMetric metric = ErrorMetric::rmse;
    double seconds = std::numeric_limits<double>::infinity();  ///< wall time, from the start of the first round
};

/// Throws InputError that names an invalid field, or the samples of a job that are too few to have a variance.
void check(const RenderTarget& target, const RenderJob& job);

/// "rmse 0.01 within 60 s".
[[nodiscard]] std::string to_string(const RenderTarget& target);

enum class StoppedBy { target, samples, time, interrupt };
[[nodiscard]] const char* to_string(StoppedBy reason);

struct TargetFrame {
    RenderedFrame frame;  ///< its film has the planes of the job
    ErrorEstimate error;
    StoppedBy stopped_by = StoppedBy::samples;
    std::string tile_samples;  ///< tile_samples_text()
    double mean_samples = 0;   ///< per pixel
};

/// Renders square tiles of target_tile_edge pixels in rounds. The first has target_first_round samples per pixel; each
/// later one doubles the samples of the tiles that are not finished, up to the samples of the job. After a round, the
/// samples so far say whether a tile will have reached the target after *one more* round, with the upper end of
/// estimate_error(); if so, that round is its last. So the samples of a last round decide nothing, and the error that
/// is reported is estimated from them alone: the samples that stop a tile are not those that judge it. (Two-stage
/// sampling: C. Stein, "A two-sample test for a linear hypothesis whose power is independent of the variance", Annals
/// of Mathematical Statistics, 1945.)
///
/// Decisions depend on the film alone, so in the exact tiers every backend draws the same bits. The time limit is the
/// exception: a round does not start if, by the time of the rounds before, it would end too late; the first always
/// does. Once `interrupted` is set, no round starts; nothing is returned if none is finished. `clock`: seconds.
///
/// Throws InputError for a frame with motion blur, whose samples are not independent.
[[nodiscard]] std::optional<TargetFrame> render_to_target(Backend& backend, const Scene& scene, const FramePlan& plan,
                                                          const RenderTarget& target,
                                                          const std::atomic<bool>& interrupted,
                                                          const std::function<double()>& clock);

inline constexpr int target_tile_edge = 32;
inline constexpr int target_first_round = 16;

/// The samples per pixel after the round that follows `samples`, of `most`. The film of a tile is the sum of the films
/// of its rounds, each rendered from zero, so that its bits depend on the rounds.
[[nodiscard]] int next_round_end(int samples, int most);

/// Whether a tile will reach the target with `factor` times its samples.
[[nodiscard]] bool will_reach(const SquaredErrors& errors, const RenderTarget& target, double factor);

/// The mean of all values of a film.
[[nodiscard]] double mean_value(const Film& film);

/// Throws InputError that says what to do if the plan is blurred.
void check_still(const FramePlan& plan);

}  // namespace tandem
