/// The x86-64 level of this processor. It is derived from single features: the oldest supported compilers cannot query
/// levels by name.
#pragma once

namespace tandem {

/// The N of the highest x86-64-vN that the processor and the system support, 4 at most; 1 below x86-64-v2, 0 on other
/// architectures.
[[nodiscard]] int x86_64_level();

}  // namespace tandem
