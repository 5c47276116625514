/// Whether kernels are made for the scene.
#pragma once

#include <string>

namespace tandem {

/// Which kernel draws a scene on the GPU: one that was compiled ahead of time, or one that is made for the scene, which
/// takes seconds the first time (PhaseTimes::compile) and is kept on disk.
enum class Specialise { never, always };

/// "never", "always". Throws InputError for others.
[[nodiscard]] Specialise parse_specialise(const std::string& text);

}  // namespace tandem
