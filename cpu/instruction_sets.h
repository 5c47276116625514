/// The compiled kernels that this processor can run.
#pragma once

#include <span>
#include <string>

#include "cpu/first_hits.h"
#include "cpu/kernels.h"

namespace tandem {

struct InstructionSet {
    const char* name;
    bool (*is_supported)();
    const TierKernels* by_tier;
    FirstHitKernel* const* first_hits_by_tier;

    [[nodiscard]] const TierKernels& kernels(Tier tier) const { return by_tier[static_cast<std::size_t>(tier)]; }
    [[nodiscard]] FirstHitKernel& first_hits(Tier tier) const {
        return *first_hits_by_tier[static_cast<std::size_t>(tier)];
    }
};

/// Those that this build has kernels for, from the least to the most capable.
[[nodiscard]] std::span<const InstructionSet> instruction_sets();

/// An empty name selects the best of this machine. Throws InputError for a name that this build does not know,
/// EnvironmentError for a set that this processor lacks.
[[nodiscard]] const InstructionSet& choose_instruction_set(const std::string& name);

/// Why this processor has none of them; empty if it has one.
[[nodiscard]] std::string why_no_instruction_set();

}  // namespace tandem
