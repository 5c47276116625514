/// What each tier must reach in the corpus of hard cases (docs/hard-corpus.md has the cases, docs/accuracy.md this
/// table).
#pragma once

#include <span>
#include <string_view>

#include "tandem/render/tier.h"

namespace tandem {

/// The most that a tier may miss of a case. NaN are never allowed. A case that has no mark for a tier is not tried on
/// it: the tier does not promise what the case asks, or has no part in it.
struct Mark {
    std::string_view case_id;
    Tier tier;
    double wrong;  ///< share of what is tried that is decided wrongly
    double ulps;   ///< worst error of t, or of the function, in units of the last place of float
    double leaks;  ///< share of rays that go through what is closed
};

/// All marks, in the order of the table.
[[nodiscard]] std::span<const Mark> marks();

/// The mark of a case and tier, or null.
[[nodiscard]] const Mark* find_mark(std::string_view case_id, Tier tier);

}  // namespace tandem
