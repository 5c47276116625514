/// The names of the accuracy tiers.
#pragma once

#include <string>
#include <string_view>

#include "tandem/render/tiers.h"

namespace tandem {

[[nodiscard]] std::string to_string(Tier tier);

/// Throws InputError that lists the tiers there are.
[[nodiscard]] Tier parse_tier(std::string_view name);

}  // namespace tandem
