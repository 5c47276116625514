/// Whether kernels are linked for the scene.
#pragma once

#include <string>

namespace tandem {

/// Which kernel renders a scene on the GPU: one compiled ahead of time, or one linked for the scene, which takes
/// seconds the first time (PhaseTimes::compile) and is cached on disk.
enum class Specialise { never, always };

/// Parses "never" or "always". Throws InputError for anything else.
[[nodiscard]] Specialise parse_specialise(const std::string& text);

}  // namespace tandem
