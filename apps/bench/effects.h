/// tandem-bench effects: what each effect of a scene costs, and how it changes the image.
#pragma once

#include "effect_ledger.h"

namespace tandem::bench {

/// Renders the scenes without, and with only, each effect that they need, times the kernel that carries all effects
/// beside the exact one, and fills `report`. False if, in strict or precise, carrying all effects changes a film, or
/// two backends that promise equal bits render an arm differently. Throws InputError without a scene.
[[nodiscard]] bool run_effects(const EffectsOptions& options, const BackendSource& source, Report& report);

}  // namespace tandem::bench
