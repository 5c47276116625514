/// The tiers that a command runs in.
#pragma once

#include <string>
#include <vector>

#include "tandem/render/tier.h"

namespace tandem::bench {

/// Throws InputError for an unknown name.
inline std::vector<Tier> parse_tiers(const std::vector<std::string>& names) {
    std::vector<Tier> tiers;
    tiers.reserve(names.size());
    for (const std::string& name : names) tiers.push_back(parse_tier(name));
    return tiers;
}

}  // namespace tandem::bench
