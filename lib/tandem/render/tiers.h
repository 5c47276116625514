/// The accuracy tiers (docs/tiers.md). Kernels include this header and not tier.h, because nvcc reads the headers of
/// strings in each of its passes.
#pragma once

namespace tandem {

/// The arithmetic of a render and its guarantees.
enum class Tier {
#define TANDEM_TIER(name, promise) name,
#include "tandem/render/tiers.def"
#undef TANDEM_TIER
};

}  // namespace tandem
