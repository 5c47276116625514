/// How many samples and how much time a frame will take, from a short probe.
#pragma once

#include <functional>

#include "tandem/render/adaptive_frame.h"

namespace tandem {

/// A value, and the interval that should have the true one in about 95 % of cases.
struct ForecastRange {
    double value = 0;
    double low = 0;
    double high = 0;
};

struct Forecast {
    ForecastRange samples{};      ///< per pixel, on average
    ForecastRange seconds{};      ///< preparation, loading and all samples; without the probe and without files
    double probe_seconds = 0;     ///< what the probe took
    ForecastRange least_error{};  ///< with the samples of the job for all pixels, if the target has an error
    bool can_reach = true;        ///< the error of the target, with the samples of the job
};

/// Renders the whole film probe_passes times with a few samples per pixel, and predicts render_to_target(), or the time
/// of the job's samples if the target has no error.
///
/// Samples: the rounds are allotted as the render does, from the errors of the probe, which are assumed to fall with
/// the number of samples as TileErrors::exponent says. The interval is from both ends of the interval of the probe's
/// error. Time: from that of the probe's samples in the same rows of tiles. For the tiles that get more samples than
/// others, it is corrected by a further pass over these tiles alone. The interval is from the spread of the passes
/// (Student's t), and from a fifth of the time for what the probe cannot show, such as smaller windows. It includes
/// neither light that the probe did not find nor other load to come.
///
/// `clock`: seconds. Throws as render_to_target() does.
[[nodiscard]] Forecast forecast(Backend& backend, const Scene& scene, const FramePlan& plan, const RenderTarget& target,
                                const std::function<double()>& clock);

inline constexpr int probe_passes = 4;

enum class Fits { yes, perhaps, no };

/// Whether the frame will be done within that time.
[[nodiscard]] Fits fits(const Forecast& forecast, double seconds);

}  // namespace tandem
