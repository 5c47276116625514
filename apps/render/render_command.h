/// tandem-render without its command line.
#pragma once

#include <atomic>
#include <string>

#include "render/render_sequence.h"

namespace tandem {

struct RenderCommand {
    std::string scene;  ///< as the user wrote it, for the report
    SequenceOptions sequence;
    std::string json;    ///< a file, "-" for standard output, or empty
    bool quiet = false;  ///< no lines and no progress bar
};

inline constexpr int exit_interrupted = 130;

/// Renders, prints a line for each frame to standard output (unless JSON goes there), shows progress on standard error
/// if that is a terminal, and writes the JSON. Returns the exit status: 0, exit_short_of_target if a frame did not
/// reach the error of its target, or exit_interrupted after printing how to resume. Throws as render_sequence() does.
[[nodiscard]] int run_render(const RenderCommand& command, const Scene& scene, Backend& backend,
                             const std::atomic<bool>& interrupted);

}  // namespace tandem
