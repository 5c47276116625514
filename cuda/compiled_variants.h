/// The sets of effects for which the render kernel is linked when Tandem is built (compiled_facts.cu).
#pragma once

#include <iterator>

#include "tandem/effects/variants.h"
#include "tandem/kernel/surface_lobes.h"
#include "tandem/kernel/threads.h"

namespace tandem::cuda {

inline constexpr KernelVariant variants[] = {
    {"plain", {}},
    {"direct", direct_effects},
    {"full", all_effects},
};
inline constexpr std::size_t variant_count = std::size(variants);

static_assert(!variants[0].effects.has_any(synchronising_effects) && variants[1].effects.has_any(synchronising_effects),
              "cuda/CMakeLists.txt links plain for short paths and direct for long ones");
static_assert(variants[2].effects == all_effects, "the last one covers every scene");

}  // namespace tandem::cuda
