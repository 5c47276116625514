/// The accuracy tiers (docs/tiers.md), without the headers of strings, which kernels do not need: nvcc reads all
/// headers four times.
#pragma once

namespace tandem {

/// The arithmetic of a render and its guarantees.
enum class Tier {
#define TANDEM_TIER(name, promise) name,
#include "tandem/render/tiers.def"
#undef TANDEM_TIER
};

}  // namespace tandem
