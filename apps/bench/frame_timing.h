/// One frame on one backend, with the time of each phase.
#pragma once

#include "tandem/effects/names.h"
#include "tandem/render/backend.h"
#include "tandem/report/row.h"
#include "tandem/scene/scene.h"

namespace tandem::bench {

struct TimedFrame {
    Film film;
    RenderStats stats;   ///< render, download
    PhaseTimes load;     ///< build, upload
    double prepare = 0;  ///< seconds from the scene to flat arrays
    double frame = 0;    ///< wall-clock seconds from the loaded scene to the film on the host; with motion blur, whose
                         ///< instants are loaded while others render, the same as `everything`
    double everything = 0;  ///< wall-clock seconds from the scene to the film: prepare, load, frame
};

/// The camera is the scene's first. With motion blur the phases are sums over the instants of the frame.
[[nodiscard]] TimedFrame render_timed(Backend& backend, const Scene& scene, const RenderJob& job,
                                      const ForcedEffects& effects = {});

/// Adds a measurement: `seconds` is the row's time, and the phases of `timed` go beside it.
void record(BenchmarkRow& row, std::int32_t round, double seconds, const TimedFrame& timed);

/// Samples of a whole frame.
[[nodiscard]] double sample_count(const RenderJob& job);

}  // namespace tandem::bench
