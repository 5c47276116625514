/// The accuracy tiers: the arithmetic of a render and its guarantees (docs/tiers.md).
#pragma once

#include <string>
#include <string_view>

namespace tandem {

enum class Tier {
#define TANDEM_TIER(name, promise) name,
#include "tandem/render/tiers.def"
#undef TANDEM_TIER
};

[[nodiscard]] std::string to_string(Tier tier);

/// Throws InputError that lists the tiers there are.
[[nodiscard]] Tier parse_tier(std::string_view name);

}  // namespace tandem
