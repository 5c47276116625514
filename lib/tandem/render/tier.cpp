#include "tandem/render/tier.h"

#include "tandem/base/error.h"

namespace tandem {

std::string to_string(Tier tier) {
    switch (tier) {
#define TANDEM_TIER(name, promise) \
    case Tier::name:               \
        return #name;
#include "tandem/render/tiers.def"
#undef TANDEM_TIER
    }
    return "unknown";
}

Tier parse_tier(std::string_view name) {
    std::string known;
#define TANDEM_TIER(tier, promise)        \
    if (name == #tier) return Tier::tier; \
    known += (known.empty() ? "" : ", ") + std::string(#tier);
#include "tandem/render/tiers.def"
#undef TANDEM_TIER
    throw InputError("there is no accuracy tier '" + std::string(name) + "'; the tiers are " + known);
}

}  // namespace tandem
