/// tandem-bench effects: what each effect of a scene costs, and what it buys.
#pragma once

#include "effect_ledger.h"

namespace tandem::bench {

/// Leaves out and adds in each effect that the scenes call for, and times the kernel that carries all effects beside
/// the exact one; fills `report`. False if, in strict or precise, carrying all effects changes a film, or two backends
/// that promise bits draw an arm differently. Throws InputError without a scene.
[[nodiscard]] bool run_effects(const EffectsOptions& options, const BackendSource& source, Report& report);

}  // namespace tandem::bench
