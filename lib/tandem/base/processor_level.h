/// Which of the x86-64 levels this processor has. Asks by features: compilers of our oldest systems do not know the
/// levels by name.
#pragma once

namespace tandem {

/// The N of the highest x86-64-vN that the processor and the system support, 4 at most; 1 below x86-64-v2, 0 on other
/// architectures.
[[nodiscard]] int x86_64_level();

}  // namespace tandem
