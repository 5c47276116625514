/// tandem-bench targets: checks the performance targets. Everything is measured in one run, on this machine.
#pragma once

#include <string>
#include <vector>

#include "backend_source.h"
#include "common/arguments.h"
#include "tandem/report/report.h"

namespace tandem::bench {

struct TargetOptions {
    std::vector<std::string> only;  ///< ids; empty means all
    FilmSize size{1000, 900};
    int samples = 100;
    FrameRange frames{0, 119};        ///< of the animation whose wall-clock time is measured
    FilmSize scale_size{3840, 2160};  ///< of the frames that several GPUs share
    int scale_samples = 64;
    int ray_edge = 2048;
    int repetitions = 7;
    std::string scenes = "assets/scenes";  ///< the folder of the scenes whose frames are timed
    std::string mitsuba_script = "scripts/versus_mitsuba.py";
    int gpu_frame_samples = 64, cpu_frame_samples = 4;  ///< of those frames, whose size is `size`
    std::string folder = "out/targets";                 ///< for the images of the animation
};

enum class Verdict { met, missed, not_measured };

struct TargetResult {
    std::string id;
    std::string statement;
    double required = 0;
    double measured = 0;
    std::string shown;  ///< the measured value with its interval, as text
    Verdict verdict = Verdict::not_measured;
    std::string why_not;  ///< why it was not measured, if it was not
    std::string command;  ///< the command that measures only this target
};

/// Ids and statements of all targets, for usage texts; with the thread counts of a machine of `cores` cores.
[[nodiscard]] std::vector<TargetResult> list_targets(int cores);

/// Measures and fills `report`. True if no target that could be measured is missed. Throws InputError for an unknown
/// id.
[[nodiscard]] bool run_targets(const TargetOptions& options, const BackendSource& source, Report& report);

}  // namespace tandem::bench
