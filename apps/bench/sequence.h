/// A whole animation as in production: frames in flight on the backend, files written by other threads.
#pragma once

#include <string>

#include "common/arguments.h"
#include "tandem/render/backend.h"
#include "tandem/scene/scene.h"

namespace tandem::bench {

/// The target for rendering's share of the wall-clock time.
inline constexpr double least_render_share = 0.95;

enum class SequenceOutput {
    none,      ///< films are discarded
    png,       ///< one file per frame, by the encoding threads together, from levels that the backend finds
    ppm_text,  ///< P3, one thread a file
};

struct SequenceOptions {
    FrameRange frames;
    SequenceOutput output = SequenceOutput::none;
    std::string folder;  ///< for the files, which must exist; frame-0007.png
    int encoders = 0;    ///< encoding threads; 0 means one less than the cores, at least one
    int in_flight = 3;   ///< frames submitted but not yet fetched
};

/// Seconds. Sums over frames, except for `wall`.
struct SequenceTimes {
    int frames = 0;
    int encoders = 0;
    double wall = 0;    ///< from before the first frame to after the last file
    double render = 0;  ///< kernel time
    double download = 0;
    double host = 0;     ///< prepare and load, on the thread that drives the backend
    double encode = 0;   ///< over all encoding threads
    double blocked = 0;  ///< time in which the driving thread waited for an encoder
    double head = 0;     ///< part of `wall`: until the first frame was submitted
    double tail = 0;     ///< part of `wall`: since the last frame was on the host
    RenderCounters counters;

    /// Share of the wall-clock time in which the backend rendered.
    [[nodiscard]] double render_share() const { return wall > 0 ? render / wall : 0; }
};

/// `job.frame` is set from the options. Each frame is one instant, without motion blur. Rethrows errors of the encoding
/// threads.
[[nodiscard]] SequenceTimes render_sequence(Backend& backend, const Scene& scene, const RenderJob& job,
                                            const SequenceOptions& options);

/// The bottleneck of the sequence, in a sentence with the figures.
[[nodiscard]] std::string describe_bottleneck(const SequenceTimes& times);

}  // namespace tandem::bench
