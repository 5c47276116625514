/// Effects by name, for command lines and reports.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tandem/effects/effects.h"

namespace tandem {

struct EffectName {
    Effect effect;
    const char* name;  ///< as on command lines and in JSON
    const char* adds;  ///< what it costs
};

/// All of them, in the order of their bits.
[[nodiscard]] const std::vector<EffectName>& effect_names();

[[nodiscard]] const char* to_string(Effect effect);

/// "shadows, refraction"; "none" for the empty set.
[[nodiscard]] std::string to_string(EffectMask mask);

/// Effects that are forced on or off, whether or not the scene needs them.
struct ForcedEffects {
    EffectMask on;
    EffectMask off;
    friend constexpr bool operator==(const ForcedEffects&, const ForcedEffects&) = default;
};

/// Reads "-shadows,+refraction", "all" (every effect on) or "none" (every one off); later words win. Throws InputError
/// that names the word.
[[nodiscard]] ForcedEffects parse_effects(std::string_view text);

/// The inverse of parse_effects(); empty if nothing is forced.
[[nodiscard]] std::string to_string(const ForcedEffects& forced);

}  // namespace tandem
