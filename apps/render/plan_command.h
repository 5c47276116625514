/// tandem-render --plan without its command line.
#pragma once

#include "render/render_command.h"

namespace tandem {

/// Prints how many samples and how much time each frame will take, from a probe of the first one, and whether that is
/// within the time of the target. Returns the exit status: 0, or exit_short_of_target if it cannot be, or if it
/// cannot reach its error. Throws as forecast() does.
[[nodiscard]] int run_plan(const RenderCommand& command, const Scene& scene, Backend& backend);

}  // namespace tandem
