/// The tiers whose CUDA kernels this build compiled ahead of time (TANDEM_COMPILED_TIERS of CMake, spaces between).
#pragma once

#include <string>

#include "tandem/render/specialise.h"
#include "tandem/render/tier.h"

namespace tandem::test {

[[nodiscard]] inline bool is_compiled(Tier tier) {
    return std::string(" " TANDEM_COMPILED_TIERS " ").find(" " + to_string(tier) + " ") != std::string::npos;
}

/// For tests that draw many small scenes, and so do not wait for a kernel for each if they need not.
[[nodiscard]] inline Specialise without_waiting(Tier tier) {
    return is_compiled(tier) ? Specialise::never : Specialise::always;
}

}  // namespace tandem::test
