/// Variants: kernels compiled ahead of time for fixed sets of effects.
#pragma once

#include <cstddef>

#include "tandem/effects/effects.h"

namespace tandem {

struct KernelVariant {
    const char* name;
    EffectMask effects;
};

/// The first of `variants` that covers `effects`. They are ordered by their cost, and the last has all effects.
template <std::size_t count>
[[nodiscard]] constexpr std::size_t variant_for(const KernelVariant (&variants)[count], EffectMask effects) {
    std::size_t variant = 0;
    while (!variants[variant].effects.covers(effects)) ++variant;
    return variant;
}

}  // namespace tandem
